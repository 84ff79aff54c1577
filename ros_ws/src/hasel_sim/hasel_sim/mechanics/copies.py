"""The points of a law as they are and moved a little, lane by lane in rows, for the one call that an effect gets."""

from collections.abc import Mapping, Sequence

import numpy as np
from numba import njit

Pairs = tuple[np.ndarray, np.ndarray, float]
"""Copies in which each component is more and less, and the difference between the two."""


@njit(cache=True, fastmath=True, error_model="numpy")
def _in_rows(field, moved, step, out):
    """Write a field [n, k, lanes] to every copy of [copies, lanes, n, k], moved by a step in one component or none."""
    n, components, lanes = field.shape
    for c in range(len(moved)):
        for lane in range(lanes):
            for s in range(n):
                for i in range(components):
                    out[c, lane, s, i] = field[s, i, lane]
        if moved[c] >= 0:
            for lane in range(lanes):
                for s in range(n):
                    out[c, lane, s, moved[c]] += step[c]


@njit(cache=True, fastmath=True, error_model="numpy")
def _add_changes(found, more, less, factor, out):
    """Add what an answer [copies, lanes, n, k] changes, times a factor [lanes], to out [n, k, components, lanes].

    Component j is moved in copy more[j], and less or not at all in copy less[j].
    """
    lanes, n, k = found.shape[1:]
    for s in range(n):
        for i in range(k):
            for j in range(len(more)):
                for lane in range(lanes):
                    change = found[more[j], lane, s, i] - found[less[j], lane, s, i]
                    out[s, i, j, lane] += factor[lane] * change


class Copies:
    """Copies of a state, each moved in one component of one quantity, or as it is."""

    def __init__(self, moves: Sequence[tuple[str, int, float]], more: Mapping[str, Pairs]) -> None:
        """moves: quantity ("" for none), component and step of every copy; more: how to differentiate by each."""
        self._count, self._pairs = len(moves), more
        self._moved = {
            name: (
                np.array([component if of == name else -1 for of, component, _ in moves]),
                np.array([step for _, _, step in moves]),
            )
            for name in more
        }
        self._as_it_is = np.full(len(moves), -1), np.zeros(len(moves))

    @classmethod
    def one_sided(cls, steps: Mapping[str, float], components: int) -> "Copies":
        """The state as it is, and one copy moved up for every component of every quantity."""
        moves = [("", -1, 0.0), *((name, i, step) for name, step in steps.items() for i in range(components))]
        more = np.arange(1, len(moves)).reshape(len(steps), components)
        pairs = zip(steps, more, steps.values(), strict=True)
        return cls(moves, {name: (up, np.zeros_like(up), step) for name, up, step in pairs})

    @classmethod
    def central(cls, steps: Mapping[str, float], components: int) -> "Copies":
        """Two copies for every component of every quantity, moved up and down."""
        moves = [
            (name, i, s) for name, step in steps.items() for i in range(components) for s in (step, -step)
        ]
        more = np.arange(0, len(moves), 2).reshape(len(steps), components)
        pairs = zip(steps, more, steps.values(), strict=True)
        return cls(moves, {name: (up, up + 1, 2 * step) for name, up, step in pairs})

    def __len__(self) -> int:
        return self._count

    def rows(self, name: str, field: np.ndarray) -> np.ndarray:
        """A quantity [n, k, lanes] in every copy, [copies, lanes, n, k]."""
        n, components, lanes = field.shape
        out = np.empty((self._count, lanes, n, components))
        _in_rows(field, *self._moved.get(name, self._as_it_is), out)
        return out

    def add_derivative(self, name: str, found: np.ndarray, factor: np.ndarray, out: np.ndarray) -> None:
        """Add factor [lanes] times the derivative by a quantity to out [n, k, components, lanes].

        found: an effect's answer to the copies, [copies, lanes, n, k].
        """
        more, less, width = self._pairs[name]
        _add_changes(found, more, less, factor / width, out)


ALONE = Copies([("", -1, 0.0)], {})
"""The state as it is."""
