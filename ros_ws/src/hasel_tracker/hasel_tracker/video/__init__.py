# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Writing video, and pictures that show what the tracker sees."""
