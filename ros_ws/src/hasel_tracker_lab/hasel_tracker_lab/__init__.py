# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The tracker's laboratory: pictures with a known truth, scenes that deceive, and how often the tracker is right."""

from hasel_common.provenance import lazy_version

__getattr__ = lazy_version(__name__)
