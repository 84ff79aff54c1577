"""A commanded voltage as a step function of time, and the grid on which the drive is evaluated."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class VoltageSchedule:
    """Signed voltage [V] of the upper and lower muscle, [n, 2], each holding from its time [s] [n] to the next."""

    time: np.ndarray
    voltage: np.ndarray

    def at(self, time: np.ndarray) -> np.ndarray:
        """Voltage [V] [m, 2] at times [s] [m]; 0 V before the first."""
        index = np.searchsorted(self.time, time, side="right") - 1
        return np.where(index[:, None] >= 0, self.voltage[np.maximum(index, 0)], 0.0)

    def switches(self) -> np.ndarray:
        """Instants [s] at which the voltage changes."""
        before = np.vstack([np.zeros(2), self.voltage[:-1]])
        return self.time[np.any(self.voltage != before, axis=1)]

    def levels(self) -> np.ndarray:
        """Magnitudes [V] above zero that occur, ascending."""
        magnitudes = np.unique(np.abs(self.voltage))
        return magnitudes[magnitudes > 0]

    def sampled(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Times and voltages of a signal that has every one of `times` and both sides of every switch."""
        switches = self.switches()
        switches = switches[(switches > times[0]) & (switches <= times[-1])]
        time = np.sort(np.concatenate([times, switches, switches]))
        after = self.at(time)
        first = np.concatenate([[False], np.diff(time) > 0]) & np.isin(time, switches)
        before = self.at(np.nextafter(time[first], -np.inf))
        after[first] = before
        return time, after
