"""Where a recording has a lift: from rest to a voltage that is held."""

from dataclasses import dataclass

import numpy as np

from hasel_muscle.recording import BenchRecording

WINDOW_S = 0.5
"""After a lift for as long as this it is compared."""
SAME = 0.01
"""Voltages no further apart than this share of the largest are one."""
_REST_S, _HELD_S = 0.3, 0.3
"""A lift is from a rest as long as this to a voltage that is held as long as this."""
_SLOWEST_SAMPLES = 200.0
"""Samples per second below which no swing is seen."""
_KEPT_S = 4e-3
"""Samples are compared this far apart."""


@dataclass(frozen=True)
class HeldStretch:
    """A lift in a recording: level [V], numbers of the samples that are compared, contraction at rest before [m]."""

    level: float
    samples: np.ndarray
    zero: float


def shows_swings(recording: BenchRecording) -> bool:
    """Whether a load hangs and samples are dense enough to see it swing."""
    step = float(np.median(np.diff(recording.time)))
    return recording.held == "load" and step > 0 and 1 / step >= _SLOWEST_SAMPLES


def stretches_of(recording: BenchRecording) -> list[HeldStretch]:
    """Lifts from rest to a voltage that is held."""
    time, voltage = recording.time, np.abs(recording.voltage)
    same = SAME * float(voltage.max())
    if same == 0:
        return []
    rising = np.flatnonzero((voltage[:-1] <= same) & (voltage[1:] > same)) + 1
    kept = max(1, round(_KEPT_S / float(np.median(np.diff(time)))))
    found = []
    for start in rising.tolist():
        before = (time >= time[start] - _REST_S) & (time < time[start] - 1e-9)
        held = (time >= time[start] + 0.02) & (time <= time[start] + _HELD_S)
        window = np.flatnonzero((time >= time[start]) & (time <= time[start] + WINDOW_S))[::kept]
        rest = recording.contraction[before]
        if not before.any() or not held.any() or not np.isfinite(rest).any():
            continue
        level = float(np.median(voltage[held]))
        quiet = voltage[before].max() <= same and time[start] - time[0] >= _REST_S
        if quiet and np.ptp(voltage[held]) <= 2 * same and np.isfinite(recording.contraction[window]).any():
            found.append(HeldStretch(float(f"{level:.3g}"), window, float(np.nanmedian(rest))))
    return found
