"""Whether a search would come near what another model leaves, at the pace at which it goes."""

import math

_NEAR = 4.0
"""Squares so many times another model's, twice its rms, may still be as likely where slow deviations count for less."""


class Pace:
    """The steps that a search has taken.

    against: squares that another model leaves, 0 for none; most: evaluations that the search is given.
    """

    def __init__(self, against: float, most: int) -> None:
        self.against, self.most = against, most
        self._before: tuple[float, int] | None = None
        self._paces: list[float] = []

    def leads_nowhere(self, squares: float, count: int) -> bool:
        """After a step that was taken, to this sum of squares and after so many evaluations: whether the larger share
        that each of its last two steps gave, an evaluation, would not bring it near the other model with those left.

        One short step tells nothing: the next may be free of what held it back.
        """
        before, self._before = self._before, (squares, count)
        if before is None or squares <= 0 or self.against <= 0:
            return False
        self._paces.append(math.log(before[0] / squares) / max(count - before[1], 1))
        if len(self._paces) < 2:
            return False
        still = math.log(squares / (_NEAR * self.against))
        return still > max(self._paces[-2:]) * (self.most - count)
