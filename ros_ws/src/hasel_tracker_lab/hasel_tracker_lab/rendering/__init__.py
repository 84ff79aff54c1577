# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Pictures of a moving swimmer with known truth, as a camera would take them."""

CODECS = ("mjpeg", "h264")
