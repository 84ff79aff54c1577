# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Two searches on the same cases: what one gets right and the other does not.

McNemar's exact test (Psychometrika 12 (1947) 153) of every share: of the cases on which the two differ, as many are to
be expected either way.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import binomtest

from hasel_benchmark.bench_hidden.outcome import Outcome
from hasel_benchmark.bench_hidden.scores import LINES, Line, is_seen


@dataclass(frozen=True)
class Paired:
    """A line on the cases that both are counted for. before, after: of how many of them it holds; only_before,
    only_after: names of the cases on which it does for one alone.
    """

    line: Line
    cases: int
    before: int
    after: int
    only_before: tuple[str, ...]
    only_after: tuple[str, ...]

    @property
    def chance(self) -> float:
        """Of a difference like this, or a larger one, between searches that are equally good."""
        differ = len(self.only_before) + len(self.only_after)
        return float(binomtest(len(self.only_after), differ, 0.5).pvalue) if differ else 1.0

    def __str__(self) -> str:
        counts = f"{self.before:4d} {self.after:4d} of {self.cases:4d}"
        differ = [*(f"-{name}" for name in self.only_before), *(f"+{name}" for name in self.only_after)]
        return f"{self.line.what:84s} {counts}  p = {self.chance:.3f}  {' '.join(differ)}".rstrip()


def paired(before: Mapping[str, Outcome], after: Sequence[Outcome]) -> list[Paired]:
    """Every line on the cases that both answered; outcomes of the earlier search by the name of their case."""
    both = _answered_by_both(before, after)
    found = []
    for line in LINES:
        counted = [(old, new) for old, new in both if line.among(old) and line.among(new)]
        held = [(line.holds(old), line.holds(new), new.case) for old, new in counted]
        found.append(
            Paired(
                line,
                len(held),
                sum(old for old, _, _ in held),
                sum(new for _, new, _ in held),
                tuple(case for old, new, case in held if old and not new),
                tuple(case for old, new, case in held if new and not old),
            )
        )
    return found


def _answered_by_both(
    before: Mapping[str, Outcome], after: Sequence[Outcome]
) -> list[tuple[Outcome, Outcome]]:
    both = [(before[o.case], o) for o in after if o.case in before]
    return [(old, new) for old, new in both if not (old.failure or new.failure)]


def group_sizes(before: Mapping[str, Outcome], after: Sequence[Outcome]) -> str:
    """Mean size of the stated group in both, where one visible effect is hidden."""
    both = _answered_by_both(before, after)
    sizes = [(old.group_size, new.group_size) for old, new in both if is_seen(old) and is_seen(new)]
    if not sizes:
        return "no case has a group in both"
    first, second = np.mean(sizes, axis=0)
    return f"mean size of the stated group before and after: {first:.2f}, {second:.2f}"


def times(before: Mapping[str, Outcome], after: Sequence[Outcome]) -> str:
    """Seconds of both on the cases that both answered, and of a case their median ratio."""
    both = [(old.seconds, new.seconds) for old, new in _answered_by_both(before, after)]
    finite = np.array([pair for pair in both if np.isfinite(pair).all()]).reshape(-1, 2)
    if not len(finite):
        return "no case was timed by both"
    median, tail = np.median(finite, axis=0), np.percentile(finite, 95, axis=0)
    return (
        f"seconds before and after: median {median[0]:.0f}, {median[1]:.0f}; 95th percentile {tail[0]:.0f}, "
        f"{tail[1]:.0f}; median ratio {np.median(finite[:, 1] / finite[:, 0]):.2f}"
    )
