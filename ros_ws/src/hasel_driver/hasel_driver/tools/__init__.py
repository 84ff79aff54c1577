# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Commands for people: console, calibration, benchmark, proof, stored charge."""
