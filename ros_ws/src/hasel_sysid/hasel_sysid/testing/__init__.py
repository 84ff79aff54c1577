# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A made-up world for tests of the search: what every effect does is known, and nothing is simulated."""
