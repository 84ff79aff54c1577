"""State of the body between two steps, and its derivatives by parameters in the same shape; in every lane."""

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np


@dataclass
class _Lanes:
    """Arrays with the lanes as their last axis, or None."""

    def lane(self, index: int):
        """What belongs to one lane, as arrays of their own."""
        arrays = vars(self).values()
        return type(self)(*(None if a is None else a[..., index : index + 1].copy() for a in arrays))

    def copy(self):
        """The same in arrays of their own."""
        arrays = vars(self).values()
        return type(self)(*(None if a is None else a.copy() for a in arrays))

    def put(self, lanes: int | np.ndarray, other, place: int | np.ndarray = 0) -> None:
        """Take over the lanes of another, from these places in it."""
        for field in fields(self):
            own = getattr(self, field.name)
            if own is not None:
                own[..., lanes] = getattr(other, field.name)[..., place]

    @classmethod
    def beside(cls, each: Sequence):
        """Several, one lane after the other."""
        names = [field.name for field in fields(cls)]
        arrays = ([getattr(one, name) for one in each] for name in names)
        return cls(*(None if a[0] is None else np.concatenate(a, axis=-1) for a in arrays))


@dataclass
class State(_Lanes):
    """Positions [m], velocities [m/s], accelerations [m/s^2] [nodes, 2, lanes].

    branch: stresses of the internal branches [Pa] [branches, elements, points, 3, lanes], None where there are none;
    green: C : E [Pa] at this state's strain [elements, points, 3, lanes], likewise.
    """

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    branch: np.ndarray | None = None
    green: np.ndarray | None = None


@dataclass
class StateSlopes(_Lanes):
    """Derivatives of a `State` by parameters: the same arrays with a leading axis of columns."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    branch: np.ndarray | None = None
    green: np.ndarray | None = None
