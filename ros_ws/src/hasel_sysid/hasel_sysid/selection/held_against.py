"""The squares that a fit must come below: it is made to its end only if it may."""

from collections.abc import Hashable

NEAR = 4.0
"""Squares so many times another model's, twice its rms, may still be as likely where slow deviations count for less."""


class HeldAgainst:
    """The least squares known when a fit was first asked for, or foreseen: so the answer does not depend on how many
    fits are made at once.
    """

    def __init__(self) -> None:
        self._least = float("inf")
        self._known: dict[Hashable, float] = {}

    def goal(self, fit: Hashable, begun: float, worth: float) -> float:
        """Near the least that is known and what the set it begins with leaves, and below what is worth anything."""
        least = self._known.setdefault(fit, self._least)
        return min(NEAR * min(least, begun), worth)

    def learn(self, squares: float) -> None:
        """What a fit has left."""
        self._least = min(self._least, squares)
