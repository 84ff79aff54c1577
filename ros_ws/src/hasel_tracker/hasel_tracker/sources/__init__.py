# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where frames come from: a camera, a video file, a folder of images, image messages."""
