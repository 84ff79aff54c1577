# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One run of an experiment in memory: the drive, which holds until the next value, and the angle of three markers."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

import numpy as np

from hasel_recording.drive_channel import HASEL_PAIR, DriveChannel
from hasel_recording.errors import RecordingError
from hasel_recording.plateaus import acting

MARKER_NAMES = ("head", "middle", "tail")
DRIVE_KEY = "drive"  # header line that names the file of the drive, beside the recording
KNOWN_KEYS = {
    "model": "model to use where --model is not given; one with an effect of your own, which is code, wants --model",
    "initial_state": "rest (default) or static_equilibrium",
    "initial_load_factor": "times all loads that act in static_equilibrium (default 1)",
    "initial_time_s": "when the body is let go (default: first frame or switch)",
    "drive": "file of the drive, beside the recording",
    "volts_per_<unit>": "the voltage columns stand for another quantity, such as volts_per_mbar: 10",
    "voltage_v": "voltage that was asked for, compared with the column",
    "frequency_hz": "frequency that was asked for, compared with the column",
    "muscles": "both, lower_first, upper or lower: which were meant to be driven",
}
"""Header lines that mean something, and what they say; any other key is kept as a note."""


def row_in_force(times: np.ndarray, at: np.ndarray | float) -> np.ndarray:
    """Number of the last row whose time is no later, [n]; -1 before the first.

    times [k] increase; at [n] in the same unit, or a single instant.
    """
    return np.searchsorted(times, at, side="right") - 1


def held(times: np.ndarray, values: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Value in force at every instant, [n, ...] of values [k, ...]; 0 before the first."""
    row = row_in_force(times, at)
    known = (row >= 0).reshape(-1, *[1] * (np.ndim(values) - 1))
    return np.where(known, values[np.maximum(row, 0)], 0.0)


def sin_theta_from_markers(markers: np.ndarray) -> np.ndarray:
    """Return sin θ = cross(v_HM, v_MT) / (|v_HM| |v_MT|), shape [...], y up.

    markers: [..., 3, 2], head, middle, tail in any one unit; v_HM points from head to middle, v_MT from middle
    to tail. Markers that coincide give NaN.
    """
    chords = np.diff(markers, axis=-2)
    return turn_between(chords[..., 0, :], chords[..., 1, :])[0]


def turn_between(first: np.ndarray, second: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return (sin θ, θ [rad]) of the turn from one vector to another, both [..., 2], y up, anticlockwise positive.

    NaN where either has no length.
    """
    cross = first[..., 0] * second[..., 1] - first[..., 1] * second[..., 0]
    lengths = np.hypot(first[..., 0], first[..., 1]) * np.hypot(second[..., 0], second[..., 1])
    nowhere = np.full(np.shape(cross), np.nan)
    sine = np.divide(cross, lengths, out=nowhere, where=lengths > 0)
    angle = np.arctan2(cross, (first * second).sum(axis=-1))
    return sine, np.where(lengths > 0, angle, np.nan)


@dataclass(frozen=True)
class Recording:
    """A run: what drove the body and the bending that was measured, frame by frame.

    name: short name, unique enough for a table; path: the file it came from.
    metadata: the header lines, such as `model` or `initial_time_s`, as text.
    time_s: [n], increasing.
    sin_theta: [n]; NaN in a frame in which a marker was lost.
    drive_signal: [n, channels] in the channels' SI units, signed, each row holding until the next; None: passive.
    channels: what the columns of the drive are; the rig's two voltages unless said otherwise.
    markers: [n, m, 2], in the order of marker_names along the body, x and y, in `marker_unit`; None: not recorded.
    marker_unit: "m" (y up) or "px" (y down, as in an image).
    drive_time_s [k], drive_values [k, channels]: the exact instants at which the drive changed and what it
    changed to, where these do not all coincide with frames; otherwise None.
    simulated_time_s, simulated_sin_theta: [k], what a simulator said during the run; None when not recorded.
    understood: what the reader made of columns that are not called as expected, one sentence each.

    Raises RecordingError where drive or markers do not have one column per name, or times come without what was then.
    """

    name: str
    time_s: np.ndarray
    sin_theta: np.ndarray
    drive_signal: np.ndarray | None = None
    markers: np.ndarray | None = None
    marker_unit: str = "m"
    metadata: dict[str, str] = field(default_factory=dict)
    path: Path | None = None
    drive_time_s: np.ndarray | None = None
    drive_values: np.ndarray | None = None
    simulated_time_s: np.ndarray | None = None
    simulated_sin_theta: np.ndarray | None = None
    channels: tuple[DriveChannel, ...] = HASEL_PAIR
    marker_names: tuple[str, ...] = MARKER_NAMES
    understood: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for what, times, values in (
            ("exact drive", self.drive_time_s, self.drive_values),
            ("simulated angle", self.simulated_time_s, self.simulated_sin_theta),
        ):
            if (times is None) != (values is None):
                raise RecordingError(
                    f"{self.name} has times or values of its {what}, but not both: give both, or neither."
                )
        for signal in (self.drive_signal, self.drive_values):
            if signal is not None and signal.shape[1] != len(self.channels):
                raise RecordingError(
                    f"{self.name} is driven by {signal.shape[1]} signals, but names {len(self.channels)} channels: "
                    "name every channel."
                )
        if self.markers is not None and self.markers.shape[1] != len(self.marker_names):
            raise RecordingError(
                f"{self.name} has {self.markers.shape[1]} markers, but names {len(self.marker_names)}: "
                "name every marker."
            )

    @property
    def duration_s(self) -> float:
        """Time from the first to the last frame [s]."""
        return float(self.time_s[-1] - self.time_s[0])

    @property
    def valid(self) -> np.ndarray:
        """Which frames have an angle, [n]."""
        return np.isfinite(self.sin_theta)

    @property
    def angle_markers(self) -> np.ndarray | None:
        """Head, middle and tail, whose angle sin_theta is, [n, 3, 2] in marker_unit; None where not recorded."""
        if self.markers is None or not set(MARKER_NAMES) <= set(self.marker_names):
            return None
        return self.markers[:, [self.marker_names.index(name) for name in MARKER_NAMES]]

    @property
    def driven(self) -> bool:
        """Whether a drive was recorded, be it zero throughout."""
        return self.drive_signal is not None or self.drive_values is not None

    @property
    def voltage(self) -> np.ndarray | None:
        """Voltage [V] of the upper and the lower muscle, [n, 2]; None for a passive body.

        Raises RecordingError where the body is driven by anything but the rig's two voltages.
        """
        self.check_hasel_pair()
        return self.drive_signal

    def check_hasel_pair(self) -> None:
        """Raise RecordingError where anything but the rig's two voltages drives the body."""
        if self.driven and self.channels != HASEL_PAIR:
            raise RecordingError(
                f"{self.name} is driven by {', '.join(c.column for c in self.channels)}, where "
                f"{' and '.join(c.column for c in HASEL_PAIR)} are expected: give a recording of the HASEL rig."
            )

    def drive(self) -> tuple[np.ndarray, np.ndarray]:
        """Return what acts: (times [s] [k], values in SI units [k, channels]), each value holding until the next time.

        A measured drive that stands on plateaus acts without its ripple. The passive body's drive is zero from the
        first frame on.
        """
        return self.recorded_drive()[0], self._acting[0]

    @property
    def ripple(self) -> tuple[str, ...]:
        """One sentence for each channel of the drive whose ripple was taken off."""
        return self._acting[1]

    @cached_property
    def _acting(self) -> tuple[np.ndarray, tuple[str, ...]]:
        return acting(self.channels, self.recorded_drive()[1])

    def recorded_drive(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the drive as it was recorded, ripple included, in the form of `drive`."""
        if self.drive_time_s is not None and self.drive_values is not None:
            return self.drive_time_s, self.drive_values
        if self.drive_signal is not None:
            return self.time_s, self.drive_signal
        return self.time_s[:1], np.zeros((1, len(self.channels)))

    def __str__(self) -> str:
        frames = len(self.time_s)
        text = f"{self.name}: {frames} frames in {self.duration_s:.3g} s"
        if frames > 1:
            text += f" ({1 / np.median(np.diff(self.time_s)):.4g} frames/s)"
        lost = frames - int(self.valid.sum())
        text += f", {lost} without an angle" if lost else ""
        _, values = self.drive()
        text += (
            f", up to {level_text(largest_levels(self.channels, values))}" if values.any() else ", passive"
        )
        return text + (
            f", |sin θ| up to {np.abs(self.sin_theta[self.valid]).max():.3g}" if lost < frames else ""
        )

    __repr__ = __str__


def largest_levels(channels: tuple[DriveChannel, ...], values: np.ndarray) -> dict[str, float]:
    """Return the largest magnitude of a drive [n, channels] per unit, without the units that are zero throughout."""
    largest: dict[str, float] = {}
    for channel, column in zip(channels, values.T, strict=True):
        largest[channel.unit] = max(largest.get(channel.unit, 0.0), float(np.abs(column).max(initial=0.0)))
    return {unit: value for unit, value in largest.items() if value > 0}


def level_text(levels: Mapping[str, float]) -> str:
    """Return levels per unit as "5500 V" or "25000 Pa and 0.007 m"; "passive" where there are none."""
    return " and ".join(f"{value:.5g} {unit}" for unit, value in levels.items()) or "passive"
