"""What a residual is evaluated at: motion of the nodes, drive of the muscles, memory of the material; in every lane."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True)
class DriveState:
    """Drive (voltage [V], pressure [Pa] ...) and contraction [1] of every muscle [muscles, lanes], time [s] [lanes]."""

    voltage: np.ndarray
    contraction: np.ndarray
    time: np.ndarray

    @staticmethod
    def single(voltage: np.ndarray, contraction: np.ndarray, time: float) -> "DriveState":
        """That of one lane, from voltage and contraction [muscles]."""
        return DriveState(np.asarray(voltage)[:, None], np.asarray(contraction)[:, None], np.array([time]))

    @staticmethod
    def beside(each: Sequence["DriveState"]) -> "DriveState":
        """Those of several lanes."""
        names = ("voltage", "contraction", "time")
        return DriveState(*(np.concatenate([getattr(d, name) for d in each], axis=-1) for name in names))

    @property
    def signals(self) -> np.ndarray:
        """A zero, the contraction and the drive of every muscle, and the time, [2 + 2 muscles, lanes]."""
        rest = np.zeros((1, self.contraction.shape[-1]))
        return np.concatenate([rest, self.contraction, self.voltage, self.time[None]])

    def with_contraction(self, contraction: np.ndarray) -> "DriveState":
        """The same instant with another contraction."""
        return replace(self, contraction=contraction)

    def of_lane(self, lane: int) -> dict[str, np.ndarray | float]:
        """Voltage [muscles], contraction [muscles] and time of one lane, by name."""
        return {
            "voltage": self.voltage[:, lane],
            "contraction": self.contraction[:, lane],
            "time": float(self.time[lane]),
        }


@dataclass(frozen=True)
class Motion:
    """Nodal positions [m], velocities [m/s] and accelerations [m/s^2], each [nodes, 2, lanes]."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray


@dataclass(frozen=True)
class Memory:
    """What the internal branches carry over a step: their history [elements, points, 3, lanes], the time since [s]."""

    history: np.ndarray | None = None
    step: float | np.ndarray | Sequence[float] = 0.0
