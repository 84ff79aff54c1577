"""One run as the pure numbers that are compared: frames, drive, measured and simulated angle."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from hasel_sysid.where_it_fails.drive_cycle import DriveCycle, drive_cycle


@dataclass(frozen=True)
class RunSeries:
    """A run at the frames that have both a measured and a simulated angle.

    time [s] [n]; measured, simulated: sin theta [n]; drive_time [s] [m], drive_voltage [V] [m, 2] (upper, lower, each
    holding until the next time), None for a passive body.
    """

    name: str
    time: np.ndarray
    measured: np.ndarray
    simulated: np.ndarray
    drive_time: np.ndarray | None = None
    drive_voltage: np.ndarray | None = None

    @property
    def offset(self) -> float:
        """Mean of measured minus simulated, the nuisance of the run."""
        return float((self.measured - self.simulated).mean())

    @property
    def residual(self) -> np.ndarray:
        """Measured minus simulated, the run's offset taken out, [n]."""
        return self.measured - self.simulated - self.offset

    @property
    def frame_time(self) -> float:
        """Median distance of two frames [s]."""
        return float(np.median(np.diff(self.time))) if len(self.time) > 1 else 0.0

    @cached_property
    def cycle(self) -> DriveCycle | None:
        """The drive's cycle; None for a passive body or a drive that does not repeat."""
        return None if self.drive_time is None else drive_cycle(self.drive_time, self.drive_voltage)

    @property
    def voltage(self) -> float:
        """Largest voltage magnitude [V]; 0 for a passive body."""
        return 0.0 if self.drive_voltage is None else float(np.abs(self.drive_voltage).max())

    @property
    def frequency(self) -> float:
        """Frequency of the drive [Hz]; 0 where it does not repeat."""
        return 0.0 if self.cycle is None else 1.0 / self.cycle.period


def run_series(
    name: str,
    time: np.ndarray,
    measured: np.ndarray,
    simulated: np.ndarray,
    drive: tuple[np.ndarray, np.ndarray] | None = None,
) -> RunSeries:
    """Keep the frames in which both angles are finite."""
    both = np.isfinite(measured) & np.isfinite(simulated)
    drive_time, drive_voltage = drive or (None, None)
    return RunSeries(name, time[both], measured[both], simulated[both], drive_time, drive_voltage)
