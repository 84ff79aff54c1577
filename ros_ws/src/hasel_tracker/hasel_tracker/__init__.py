# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From a camera or a video to three markers and the bending angle."""

from hasel_common.provenance import lazy_version

__getattr__ = lazy_version(__name__)
