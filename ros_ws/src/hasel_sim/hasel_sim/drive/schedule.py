# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The commanded drive as step functions of time, one per channel, and the grid on which it is evaluated."""

from dataclasses import dataclass

import numpy as np
from hasel_recording.drive_channel import HASEL_PAIR
from hasel_recording.recording import held

from hasel_sim.errors import SimulationError

HASEL_CHANNELS = tuple(channel.name for channel in HASEL_PAIR)
"""The two muscles of the HASEL rig."""


@dataclass(frozen=True)
class DriveSchedule:
    """What is commanded: signal [n, channels] in SI units, each row holding from its time [s] [n] to the next.

    The signal is signed (a voltage has a polarity). Raises SimulationError for a value that is no number.
    """

    time: np.ndarray
    signal: np.ndarray
    channels: tuple[str, ...] = HASEL_CHANNELS

    def __post_init__(self) -> None:
        if np.shape(self.signal) != (len(self.time), len(self.channels)):
            raise SimulationError(
                f"a drive of the shape {np.shape(self.signal)} was given; expected one row per time and one column for "
                f"each of {', '.join(self.channels)}: {(len(self.time), len(self.channels))}"
            )
        broken = ~(np.isfinite(self.signal).all(axis=1) & np.isfinite(self.time))
        if broken.any():
            row = int(np.flatnonzero(broken)[0])
            raise SimulationError(
                f"the drive at t = {self.time[row]:g} s is {np.asarray(self.signal)[row].tolist()}; expected finite "
                "numbers: repair or remove that row"
            )

    def at(self, time: np.ndarray) -> np.ndarray:
        """Signal [m, channels] at times [s] [m]; 0 before the first."""
        if len(self.time) == 0:
            return np.zeros((len(time), len(self.channels)))
        return held(self.time, self.signal, time)

    def switches(self) -> np.ndarray:
        """Instants [s] at which the signal changes."""
        before = np.vstack([np.zeros(len(self.channels)), self.signal[:-1]])
        return self.time[np.any(self.signal != before, axis=1)]

    def levels(self, channels: tuple[str, ...] | None = None) -> np.ndarray:
        """Magnitudes above zero that occur on some of the channels (default: on all), ascending."""
        columns = [n for n, name in enumerate(self.channels) if channels is None or name in channels]
        magnitudes = np.unique(np.abs(self.signal[:, columns]))
        return magnitudes[magnitudes > 0]

    def of(self, channels: tuple[str, ...], run: str) -> "DriveSchedule":
        """The same with just these channels, in this order; run: what to call it in an error.

        A channel too many may only rest. Raises SimulationError where one is missing or drives nothing.
        """
        for column, name in enumerate(self.channels):
            if name not in channels and np.any(self.signal[:, column]):
                raise SimulationError(
                    f"run '{run}' drives the channel '{name}', which contracts no muscle of the model; expected "
                    f"{_listed(channels)}: choose another model or remove that column"
                )
        for name in channels:
            if name not in self.channels:
                raise SimulationError(
                    f"run '{run}' has no drive for the channel '{name}', only for {_listed(self.channels)}: add its "
                    "column or choose another model"
                )
        return DriveSchedule(
            self.time, self.signal[:, [self.channels.index(name) for name in channels]], channels
        )

    def sampled(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Times and values of a signal that has every one of `times` and both sides of every switch."""
        switches = self.switches()
        switches = switches[(switches > times[0]) & (switches <= times[-1])]
        time = np.sort(np.concatenate([times, switches, switches]))
        after = self.at(time)
        first = np.concatenate([[False], np.diff(time) > 0]) & np.isin(time, switches)
        before = self.at(np.nextafter(time[first], -np.inf))
        after[first] = before
        return time, after


def no_drive(channels: tuple[str, ...]) -> DriveSchedule:
    """Nothing commanded on any of these channels, ever."""
    return DriveSchedule(np.zeros(1), np.zeros((1, len(channels))), channels)


def _listed(channels: tuple[str, ...]) -> str:
    return ", ".join(channels) or "no drive at all"
