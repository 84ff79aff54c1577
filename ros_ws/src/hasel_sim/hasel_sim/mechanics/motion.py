"""What a residual is evaluated at: motion of the nodes, drive of the muscles, memory of the material."""

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class DriveState:
    """Drive (voltage [V], pressure [Pa] ...) and contraction [1] of every muscle, [muscles], at a time [s]."""

    voltage: np.ndarray
    contraction: np.ndarray
    time: float

    def with_contraction(self, contraction: np.ndarray) -> "DriveState":
        """The same instant with another contraction."""
        return replace(self, contraction=contraction)


@dataclass(frozen=True)
class Motion:
    """Nodal positions [m], velocities [m/s] and accelerations [m/s^2], each [nodes, 2]."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


@dataclass(frozen=True)
class Memory:
    """What the internal branches carry over a step: their history [elements, points, 3] and the time since [s]."""

    history: np.ndarray | None = None
    step: float = 0.0
