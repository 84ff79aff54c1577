# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The equation of motion, its solution step by step, and what parameters change in it."""
