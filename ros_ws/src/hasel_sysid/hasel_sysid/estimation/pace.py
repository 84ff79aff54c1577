"""Whether a search would come to where it is worth anything, at the pace at which it goes."""

import math
from collections.abc import Callable


class Pace:
    """The steps that a search has taken.

    goal: squares that it must come below to be worth anything, 0 for none; most: evaluations that it is given.
    """

    def __init__(self, goal: float, most: int) -> None:
        self.goal, self.most = goal, most
        self._before: tuple[float, int] | None = None
        self._paces: list[float] = []

    def leads_nowhere(self, squares: float, count: int, foretold: Callable[[], float]) -> bool:
        """After a step that was taken, to this sum of squares and after so many evaluations: whether the share that it
        gave, an evaluation, would not bring the search to its goal with those left.

        One short step tells nothing: the next may be free of what held it back. So neither would the step before, or
        the squares foretold of the next one, whole and to first order, are not below the goal either.
        """
        before, self._before = self._before, (squares, count)
        if before is None or squares <= 0 or self.goal <= 0:
            return False
        self._paces.append(math.log(before[0] / squares) / max(count - before[1], 1))
        still = math.log(squares / self.goal)
        slow = [still > pace * (self.most - count) for pace in self._paces[-2:]]
        return slow[-1] and (slow == [True, True] or foretold() >= self.goal)
