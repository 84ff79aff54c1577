# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One run as the pure numbers that are compared: frames, drive, measured and simulated angle."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from hasel_recording import HASEL_PAIR, DriveChannel
from hasel_recording.recording import largest_levels, level_text

from hasel_sysid.residual_analysis.drive_cycle import DriveCycle, comparable, drive_cycle


@dataclass(frozen=True)
class RunSeries:
    """A run at the frames that have both a measured and a simulated angle.

    time [s] [n]; measured, simulated: sin theta [n]; drive_time [s] [m], drive_values [m, channels] in SI units, each
    holding until the next time, None for a passive body.
    """

    name: str
    time: np.ndarray
    measured: np.ndarray
    simulated: np.ndarray
    drive_time: np.ndarray | None = None
    drive_values: np.ndarray | None = None
    channels: tuple[DriveChannel, ...] = HASEL_PAIR

    @property
    def drive(self) -> tuple[np.ndarray, np.ndarray] | None:
        """Times [s] [m] and values [m, channels] of the drive; None for a passive body."""
        if self.drive_time is None or self.drive_values is None:
            return None
        return self.drive_time, self.drive_values

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
        if self.drive is None:
            return None
        time, values = self.drive
        return drive_cycle(time, comparable(values, self.channels))

    @property
    def levels(self) -> dict[str, float]:
        """Largest magnitude of the drive per unit, such as {"V": 5500.0}; empty for a passive body."""
        if self.drive_values is None:
            return {}
        return largest_levels(self.channels, self.drive_values)

    @property
    def level(self) -> float:
        """Largest magnitude of the drive, of the first unit that is driven at all; 0 for a passive body."""
        return next(iter(self.levels.values()), 0.0)

    @property
    def level_text(self) -> str:
        """Largest magnitude with its unit: "5500 V", "25000 Pa and 0.007 m", "passive"."""
        return level_text(self.levels)

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
    channels: tuple[DriveChannel, ...] = HASEL_PAIR,
) -> RunSeries:
    """Keep the frames in which both angles are finite."""
    both = np.isfinite(measured) & np.isfinite(simulated)
    drive_time, drive_values = drive or (None, None)
    return RunSeries(name, time[both], measured[both], simulated[both], drive_time, drive_values, channels)
