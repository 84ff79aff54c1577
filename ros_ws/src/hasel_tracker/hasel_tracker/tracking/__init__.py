# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From an image to markers, or a midline, and the bending angle; and what a user chooses between, quick to import."""

METHODS = ("contour", "moment", "midline", "apriltag", "csrt")
DEFAULT_METHOD = "contour"
BODY_KINDS = ("auto", "light", "dark")
