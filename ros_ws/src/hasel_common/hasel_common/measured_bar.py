# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A figure of a benchmark beside the one that it must reach."""

from dataclasses import dataclass


@dataclass(frozen=True)
class MeasuredBar:
    """What was measured, what it must reach, and whether it does."""

    what: str
    measured: float
    limit: float
    at_least: bool = False

    @property
    def met(self) -> bool:
        """Whether the bar is met."""
        return self.measured >= self.limit if self.at_least else self.measured <= self.limit
