"""The squares that a fit is held against: it is made to its end only if it may come near them."""

from collections.abc import Hashable


class HeldAgainst:
    """The least squares known when a fit was first asked for, or foreseen: so the answer does not depend on how many
    fits are made at once.
    """

    def __init__(self) -> None:
        self._least = float("inf")
        self._known: dict[Hashable, float] = {}

    def of(self, fit: Hashable) -> float:
        """The squares for a fit; infinite where none was made before it was first asked for."""
        return self._known.setdefault(fit, self._least)

    def learn(self, squares: float) -> None:
        """What a fit has left."""
        self._least = min(self._least, squares)
