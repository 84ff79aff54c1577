# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Lens and perspective from a board; the markers' colour, or how a body stands out, from one picture."""

VIEWS_FOR_LENS = 4
"""Fewest pictures of a board from which the lens is calibrated."""
