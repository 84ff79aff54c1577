# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The cycle of a drive: its period, where in it a frame lies, and which channel is pulling."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_recording import DriveChannel, Recording
from hasel_recording.recording import row_in_force

from hasel_sysid.residual_analysis.robust_statistics import high_frequency_noise

_FEW, WAVEFORM = 8, 0.5
"""A drive of more values than few that changes at more than this share of its rows goes through a continuum."""
_CLEAR_OF_NOISE, _CLEAR_OF_REST = 6.0, 0.02


@dataclass(frozen=True)
class DriveCycle:
    """start: the first time [s] a channel is driven; period [s]; switches [s] [k]; side [k]: see driven_side."""

    start: float
    period: float
    switches: np.ndarray
    side: np.ndarray

    def phase(self, time: np.ndarray) -> np.ndarray:
        """Place in the cycle, 0 to 1, of times [s] [n]."""
        return np.mod((time - self.start) / self.period, 1.0)

    def since_switch(self, time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Time [s] since the latest switch and the side it went to, both [n]; NaN and 0 before the first."""
        index = row_in_force(self.switches, time)
        seen = index >= 0
        since = np.where(seen, time - self.switches[np.maximum(index, 0)], np.nan)
        return since, np.where(seen, self.side[np.maximum(index, 0)], 0)

    def count(self, time: np.ndarray) -> float:
        """How many cycles the times [s] [n] cover."""
        return float((time[-1] - max(self.start, time[0])) / self.period)


def comparable(values: np.ndarray, channels: Sequence[DriveChannel]) -> np.ndarray:
    """The drive [n, channels] as it is where all channels have one unit, otherwise each relative to its largest."""
    if len({channel.unit for channel in channels}) <= 1:
        return values
    largest = np.abs(values).max(axis=0)
    return values / np.where(largest > 0, largest, 1.0)


def net_drive(values: np.ndarray) -> np.ndarray:
    """How much stronger the first channel is driven than the strongest other one, [n] from [n, channels]."""
    magnitude = np.abs(values)
    return magnitude[:, 0] - magnitude[:, 1:].max(axis=1, initial=0.0)


def driven_side(values: np.ndarray) -> np.ndarray:
    """+1 where the first channel is the strongest (the upper muscle), -1 where another is, 0 where none, [n]."""
    return np.sign(net_drive(values)).astype(int)


def _turned_side(values: np.ndarray) -> np.ndarray:
    """driven_side, but a drive that goes through a continuum, as a sensor's, takes a side once it clearly leaves rest.

    What a sensor gives at rest goes up and down about zero: that is no turn.
    """
    side, net = driven_side(values), net_drive(values)
    if len(np.unique(net)) <= _FEW or np.count_nonzero(np.diff(net)) <= WAVEFORM * len(net):
        return side
    clear = max(_CLEAR_OF_NOISE * high_frequency_noise(net), _CLEAR_OF_REST * float(np.abs(net).max()))
    known = (np.abs(net) > clear) | (np.abs(net) < 0.5 * clear)
    side = np.where(np.abs(net) > clear, side, 0)
    return np.append(side[:1] * 0, side)[np.maximum.accumulate(np.where(known, 1 + np.arange(len(net)), 0))]


def drive_cycle(time: np.ndarray, values: np.ndarray) -> DriveCycle | None:
    """Find the cycle of a drive at times [s] [n] with comparable values [n, channels]; None below two turns.

    With several channels a cycle is from one take-over to the next but one; with one from onset to onset.
    """
    side = _turned_side(values)
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


def cycle_of(recording: Recording) -> DriveCycle | None:
    """That of a driven recording."""
    time, values = recording.drive()
    return drive_cycle(time, comparable(values, recording.channels))


def _usual_distance(switches: np.ndarray) -> float:
    """Mean distance of switches [s], without pauses; the mean is finer than the frames that switches may lie on."""
    distances = np.diff(switches)
    return float(distances[distances < 1.5 * np.median(distances)].mean())
