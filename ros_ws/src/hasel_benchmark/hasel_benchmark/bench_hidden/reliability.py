"""Of what is called so probable, how much is right?"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hasel_benchmark.bench_hidden.outcome import Outcome
from hasel_benchmark.bench_hidden.share import wilson_interval

EDGES = (0.0, 0.2, 0.4, 0.6, 0.8, 0.95, 1.0)


@dataclass(frozen=True)
class Bin:
    """Answers whose stated probability lies between two edges: how many, its mean, and how many were right."""

    low: float
    high: float
    count: int
    stated: float
    right: int

    @property
    def share(self) -> float:
        """Of right ones."""
        return self.right / self.count

    @property
    def interval(self) -> tuple[float, float]:
        """In which the true share lies with 95 %."""
        return wilson_interval(self.share, self.count)


def reliability(outcomes: Sequence[Outcome]) -> list[Bin]:
    """Bins of the probability of the effect ranked first; where nothing is said to be missing, none was given."""
    answers = [
        (o.probability, o.right)
        for o in outcomes
        if not o.failure and o.kind != "pair" and o.first and np.isfinite(o.probability)
    ]
    found = []
    for low, high in zip(EDGES, EDGES[1:], strict=False):
        inside = [(p, right) for p, right in answers if low <= p < high or (high == EDGES[-1] and p >= high)]
        if inside:
            stated = float(np.mean([p for p, _ in inside]))
            found.append(Bin(low, high, len(inside), stated, sum(right for _, right in inside)))
    return found
