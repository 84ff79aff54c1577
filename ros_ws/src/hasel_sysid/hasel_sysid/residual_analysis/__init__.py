# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where a model fails: what its residual holds, run by run, in all runs, and over the cycle of the drive."""
