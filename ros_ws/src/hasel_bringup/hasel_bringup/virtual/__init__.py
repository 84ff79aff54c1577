# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What stands in for the hardware: the swimmer as a camera sees it, the camera, and the rig."""
