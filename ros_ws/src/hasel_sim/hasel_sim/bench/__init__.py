# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How fast the simulator is, and how exact, measured beside the bars it must meet."""
