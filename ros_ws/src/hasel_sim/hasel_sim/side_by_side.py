"""Which cases one process simulates side by side: a part for every process, and answers that do not depend on it."""

from collections.abc import Sequence
from itertools import pairwise
from typing import TypeVar

from hasel_sim.simd import LANES

Case = TypeVar("Case")


def side_by_side(cases: Sequence[Case], share: int) -> list[Sequence[Case]]:
    """The cases in batches, in their order: at most a process's share in each and as many as there are lanes.

    Whether the last is by itself follows from how many there are, not from the share: the loops for one lane round
    otherwise than those for several, and the answer would depend on how many processes there are.
    """
    size = min(LANES[-1], max(1, share))
    beside = len(cases) - (len(cases) % LANES[-1] == 1)
    count = min(-(-beside // size), beside // 2)
    ends = [beside * number // count for number in range(1, count + 1)] if count else []
    if beside < len(cases):
        ends.append(len(cases))
    return [cases[first:end] for first, end in pairwise([0, *ends])]
