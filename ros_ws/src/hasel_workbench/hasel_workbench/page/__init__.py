# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page: a thin layer over the session, on NiceGUI and plain canvases."""
