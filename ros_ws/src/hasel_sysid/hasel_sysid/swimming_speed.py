# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How fast a body swam and swims, from its markers."""

from dataclasses import dataclass

import numpy as np
from hasel_recording import Recording
from hasel_sim.run import Simulation

_LEAST_PERIODS = 3.0
"""Periods that frames must cover for a speed; half of them at the end are measured."""


@dataclass(frozen=True)
class SwimmingSpeed:
    """Speed forwards of the head marker [m/s], measured and simulated over the same whole periods at the end."""

    measured: float
    simulated: float

    @property
    def error(self) -> float:
        """Simulated minus measured [m/s]."""
        return self.simulated - self.measured


def swimming_speed(
    recording: Recording, simulation: Simulation, period: float | None, free: bool
) -> SwimmingSpeed | None:
    """Both speeds; None for a body that is held, markers that are not in metres, a drive that does not repeat, or too
    few periods.

    period: of the drive [s]; free: whether nothing holds the body or its head marker.
    """
    if not free or period is None or recording.markers is None or recording.marker_unit != "m":
        return None
    measured = forward_speed(recording.time_s, recording.markers, period)
    simulated = forward_speed(simulation.time, simulation.markers, period)
    if measured is None or simulated is None:
        return None
    return SwimmingSpeed(measured, simulated)


def forward_speed(time: np.ndarray, markers: np.ndarray, period: float) -> float | None:
    """Speed [m/s] of the first marker along the mean direction from the second to it, at times [s] [n].

    markers: [n, m, 2], NaN where lost. Means over one period at the start and one at the end of the last whole periods,
    so that the head's swing does not count.
    """
    seen = np.isfinite(markers[:, :2]).all(axis=(1, 2))
    time, head, second = time[seen], markers[seen, 0], markers[seen, 1]
    if len(time) < 8 or time[-1] - time[0] < _LEAST_PERIODS * period:
        return None
    periods = max(2, int((time[-1] - time[0]) / period / 2))
    last = time > time[-1] - period
    first_end = time[-1] - (periods - 1) * period
    first = (time > first_end - period) & (time <= first_end)
    if np.count_nonzero(first) < 4 or np.count_nonzero(last) < 4:
        return None
    late = time > first_end - period
    ahead = (head - second)[late].mean(axis=0)
    moved = head[last].mean(axis=0) - head[first].mean(axis=0)
    between = time[last].mean() - time[first].mean()
    return float(moved @ ahead / np.linalg.norm(ahead) / between)
