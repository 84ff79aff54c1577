# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The Peano-HASEL muscle without a body: the zipping pouch, what its analytic model lacks, and its file."""
