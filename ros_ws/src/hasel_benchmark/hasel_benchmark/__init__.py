# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The naming benchmark: how often `improve` names what was hidden from it."""

from hasel_common.provenance import lazy_version

__getattr__ = lazy_version(__name__)
