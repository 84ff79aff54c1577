"""The cycle of a drive: its period, where in it a frame lies, and which muscle is pulling."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class DriveCycle:
    """start: the first time [s] a muscle is driven; period [s]; switches [s] [k] with side [k]: +1 upper, -1 lower."""

    start: float
    period: float
    switches: np.ndarray
    side: np.ndarray

    def phase(self, time: np.ndarray) -> np.ndarray:
        """Place in the cycle, 0 to 1, of times [s] [n]."""
        return np.mod((time - self.start) / self.period, 1.0)

    def since_switch(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Time [s] since the latest switch and the side it went to, both [n]; NaN and 0 before the first."""
        index = np.searchsorted(self.switches, time, side="right") - 1
        seen = index >= 0
        since = np.where(seen, time - self.switches[np.maximum(index, 0)], np.nan)
        return since, np.where(seen, self.side[np.maximum(index, 0)], 0)

    def count(self, time: np.ndarray) -> float:
        """How many cycles the times [s] [n] cover."""
        return float((time[-1] - max(self.start, time[0])) / self.period)


def driven_side(voltage: np.ndarray) -> np.ndarray:
    """+1 where the upper muscle has the higher voltage, -1 where the lower has, 0 where neither, [n] from [n, 2]."""
    magnitude = np.abs(voltage)
    return np.sign(magnitude[:, 0] - magnitude[:, 1]).astype(int)


def drive_cycle(time: np.ndarray, voltage: np.ndarray) -> DriveCycle | None:
    """Find the cycle of a drive at times [s] [n] with voltages [V] [n, 2]; None where fewer than two turns occur.

    With both muscles a cycle is from one take-over to the next but one; with one muscle from onset to onset.
    """
    side = driven_side(voltage)
    changes = np.flatnonzero(np.diff(side, prepend=0) != 0)
    onset = changes[side[changes] != 0]
    if len(onset) < 2:
        return None
    switches, sides = time[onset], side[onset]
    other = np.diff(sides, prepend=-sides[0]) != 0
    if np.count_nonzero(other) > 1:
        switches, sides = switches[other], sides[other]
        period = 2.0 * _usual_distance(switches)
    else:
        period = _usual_distance(switches)
    return DriveCycle(float(switches[0]), period, switches, sides)


def _usual_distance(switches: np.ndarray) -> float:
    """Mean distance of switches [s], without pauses; the mean is finer than the frames that switches may lie on."""
    distances = np.diff(switches)
    return float(distances[distances < 1.5 * np.median(distances)].mean())
