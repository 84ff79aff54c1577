# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Planar finite elements of the swimmer, its muscles and the physical effects on it."""

from hasel_common.provenance import lazy_version

__getattr__ = lazy_version(__name__)
