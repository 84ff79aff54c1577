# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Launch files, configurations and the demonstration of the HASEL swimmer stack."""

from hasel_common.provenance import lazy_version

__getattr__ = lazy_version(__name__)
