# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The laws of effects, compiled: what an effect's method does with one point is recorded once, differentiated as an
expression, and done again for all points by one compiled loop.
"""
