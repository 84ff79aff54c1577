# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a search comes to: faults of the set-up, what is said of every effect, the verdict, and the next run."""
