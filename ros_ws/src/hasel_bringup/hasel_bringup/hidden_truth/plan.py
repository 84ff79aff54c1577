# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The standard plan of experiments: the seed paper's nine fitted runs and three unseen ones."""

from dataclasses import dataclass

import numpy as np
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.run import Run

FRAMES_PER_SECOND = 120.0
_PERIODS = 2


@dataclass(frozen=True)
class BoxRun:
    """Two periods of a box drive: the upper muscle at the voltage [V] for the first half of each, then the lower."""

    voltage: float
    frequency: float
    unseen: bool = False

    @property
    def name(self) -> str:
        """Such as `fit_3500V_0.5Hz`."""
        return f"{'val' if self.unseen else 'fit'}_{self.voltage:.0f}V_{self.frequency:.1f}Hz"

    def run(self, switch_on_frames: bool = False) -> Run:
        """Frames and drive; switch_on_frames moves each switch to the next frame, all that a CSV file can hold."""
        frames = np.arange(np.ceil(_PERIODS / self.frequency * FRAMES_PER_SECOND) + 1) / FRAMES_PER_SECOND
        switches = np.arange(2 * _PERIODS + 1) / (2 * self.frequency)
        if switch_on_frames:
            switches = np.ceil(switches * FRAMES_PER_SECOND - 1e-9) / FRAMES_PER_SECOND
        upper = np.arange(len(switches)) % 2 == 0
        voltage = np.where(np.stack([upper, ~upper], axis=1), self.voltage, 0.0)
        return Run(self.name, frames, DriveSchedule(switches, voltage))


FITTED = tuple(BoxRun(voltage, f) for voltage in (3500.0, 4500.0, 5500.0) for f in (0.5, 2.0, 3.5))
UNSEEN = tuple(BoxRun(voltage, 2.5, unseen=True) for voltage in (4250.0, 4800.0, 5200.0))
