# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What can go wrong with a benchmark; every message is one sentence with a next step."""


class BenchmarkError(Exception):
    """The benchmark cannot be run as it was asked for."""
