# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Faults of the command: unit, dead or doubled channel, clipping, irregular switching, a faked command."""

import numpy as np
from hasel_recording import HASEL_PAIR, Recording

from hasel_sysid.data_quality.finding import DataFinding, error, warning
from hasel_sysid.residual_analysis.drive_cycle import comparable, cycle_of, net_drive
from hasel_sysid.residual_analysis.robust_statistics import high_frequency_noise

_LIKELY = {
    "voltage": (20.0, np.inf, "kilovolts"),
    "pressure": (50.0, 1e8, "bar, mbar or kPa"),
    "travel": (0.0, 1.0, "millimetres"),
}
"""Largest magnitudes [SI] between which a drive is in its SI unit, and what it is in otherwise."""
_FEW_LEVELS = 8
_WORTH_SAYING = 4.0
"""A motion within a switch's uncertainty counts where it is this many times the noise."""
_ROUNDING = 1e-4
"""Share of the angle's range to which recordings round."""
_SEEN_AT_FRAMES = 2.05
"""A switch is seen up to one frame late, so regular ones seem to be up to two frames more or less apart."""


def check_command(recording: Recording) -> list[DataFinding]:
    """Faults of the drive, by itself and against the header lines; none for a passive body."""
    if not recording.driven:
        return []
    time, values = recording.drive()
    if not np.all(np.isfinite(values)):
        lost = int(np.count_nonzero(~np.isfinite(values).all(axis=1)))
        return [error("lost command", lost, f"{lost} rows of the drive are NaN", "record the supply's state")]
    if not values.any():
        zeros = ", ".join(channel.shown(0.0) for channel in recording.channels[:1])
        evidence = f"the drive is {zeros} all the time"
        return [warning("no command", 0.0, evidence, "arm the supply, or leave the drive's columns out")]
    return [
        *_unit(recording, values),
        *_channels(recording, values),
        *_clipping(recording, values),
        *_switching(recording, time, values),
        *_faked(recording),
    ]


def _unit(recording: Recording, values: np.ndarray) -> list[DataFinding]:
    found = []
    for quantity, (least, most, others) in _LIKELY.items():
        own = [
            column for column, c in zip(values.T, recording.channels, strict=True) if c.quantity == quantity
        ]
        channel = next((c for c in recording.channels if c.quantity == quantity), None)
        largest = float(np.abs(own).max()) if own else 0.0
        if channel is None or largest == 0 or least < largest <= most:
            continue
        evidence = f"the largest {quantity} is {channel.shown(largest)}"
        advice = f"is it in {others}? then say so at the end of the column's name"
        found.append(error(f"unit of the {quantity}", largest, evidence, advice))
    return found


def _channels(recording: Recording, values: np.ndarray) -> list[DataFinding]:
    used = np.abs(values).max(axis=0) > 0
    names = [channel.name for channel in recording.channels]
    both = recording.metadata.get("muscles", "both") in ("both", "lower_first")
    if used.all():
        if len(names) == 1 or not np.all(values == values[:, :1]):
            return []
        evidence = "both muscles get" if len(names) == 2 else "all channels get"
        evidence = f"{evidence} the same {recording.channels[0].quantity} all the time"
        return [error("doubled channel", 1.0, evidence, "check which columns were recorded")]
    if not both:
        return []
    said = "muscles" in recording.metadata
    found = []
    for channel in (channel for channel, own in zip(recording.channels, used, strict=True) if not own):
        muscle = f"the {channel.name} muscle" if channel in HASEL_PAIR else f"channel {channel.name}"
        evidence = f"{muscle} never gets a {channel.quantity}"
        if said:
            evidence = f"{evidence}, the header says both"
            found.append(error("dead channel", 0.0, evidence, "check the supply's channel"))
        else:
            found.append(
                warning(
                    "dead channel", 0.0, evidence, f"check the {channel.name} channel unless this is meant"
                )
            )
    return found


def _clipping(recording: Recording, voltage: np.ndarray) -> list[DataFinding]:
    """A command that stays below what was asked for, or at a limit; only the rig's supply has one that is known."""
    if recording.channels != HASEL_PAIR:
        return []
    magnitude = np.abs(voltage)
    largest = float(magnitude.max())
    found = []
    asked = _number(recording.metadata.get("voltage_v"))
    if asked is not None and largest < 0.99 * asked:
        evidence = f"the header asks for {asked:g} V and {largest:g} V are commanded at most"
        found.append(error("clipped command", largest, evidence, "raise the limit or ask for less"))
    own = magnitude.max(axis=0)
    if not found and own.min() > 0 and own.min() < 0.99 * own.max():
        lower = HASEL_PAIR[int(np.argmin(own))].name
        evidence = f"the {lower} muscle gets {own.min():g} V, the other one {own.max():g} V"
        found.append(warning("clipped command", own.min(), evidence, "check the limits of both channels"))
    driven = magnitude[magnitude > 0]
    at_limit = float(np.mean(driven == largest))
    if not found and len(np.unique(driven)) >= _FEW_LEVELS and at_limit > 0.15:
        evidence = f"a waveform of many levels stays at {largest:g} V for {at_limit:.0%} of the time"
        found.append(warning("clipped command", at_limit, evidence, "raise the limit or ask for less"))
    return found


def _switching(recording: Recording, time: np.ndarray, values: np.ndarray) -> list[DataFinding]:
    cycle = cycle_of(recording)
    if cycle is None:
        if recording.channels != HASEL_PAIR:
            return []  # one step up and down is how pressures and tendons are tried
        evidence = "the drive never switches from one muscle to the other or off and on"
        return [warning("too little excitation", 1.0, evidence, "record at least one whole period")]
    frame = float(np.median(np.diff(recording.time_s)))
    distances = _recurrences(time, values)
    if len(distances):
        spread = float(np.ptp(distances))
        if spread > max(_SEEN_AT_FRAMES * frame, 0.05 * float(np.median(distances))):
            low, high = distances.min() * 1e3, distances.max() * 1e3
            evidence = f"switches that should be one period apart are {low:.0f} to {high:.0f} ms apart"
            return [
                warning("shifted command", spread, evidence, "record what the supply did, not what was asked")
            ]
    asked = _number(recording.metadata.get("frequency_hz"))
    if asked and abs(1 / cycle.period / asked - 1) > 0.03 + frame / cycle.period:
        evidence = f"the header says {asked:g} Hz and the command switches at {1 / cycle.period:.3g} Hz"
        return [warning("shifted command", 1 / cycle.period, evidence, "correct the header or the clock")]
    return _between_frames(recording, time, values, frame)


def _between_frames(
    recording: Recording, time: np.ndarray, values: np.ndarray, frame: float
) -> list[DataFinding]:
    """Switches that fall between frames, where the drive is known at the frames only and the body moves fast."""
    changes = time[1 + np.flatnonzero(np.any(np.diff(values, axis=0) != 0, axis=1))]
    distances = np.diff(changes)
    if recording.drive_time_s is not None or len(distances) < 2:
        return []
    if not 0.5 * frame < np.ptp(distances) < 1.5 * frame:  # all alike: they lie on frames
        return []
    sin_theta = recording.sin_theta[recording.valid]
    moved = float(np.sqrt(np.mean(np.diff(sin_theta) ** 2))) / np.sqrt(12.0)
    if moved < _WORTH_SAYING * high_frequency_noise(sin_theta):
        return []
    evidence = (
        f"the drive is known at the frames only, {1e3 * frame:.3g} ms apart, and switches between them, in which time "
        f"the body moves by {moved:.2g} (rms)"
    )
    advice = (
        "no fit can become better than that: give the drive's own recording with --drive, as `track` and `convert` "
        "write it beside"
    )
    return [warning("switches between frames", moved, evidence, advice)]


def _recurrences(time: np.ndarray, values: np.ndarray) -> np.ndarray:
    """Distances [s] of switches between the same two values, pauses left out; empty for a waveform of many values."""
    changes = 1 + np.flatnonzero(np.any(np.diff(values, axis=0) != 0, axis=1))
    kinds: dict[bytes, list[float]] = {}
    for row in changes:
        kinds.setdefault(values[row - 1 : row + 1].tobytes(), []).append(float(time[row]))
    distances = np.concatenate([np.diff(own) for own in kinds.values()]) if kinds else np.zeros(0)
    if len(distances) < 2:
        return np.zeros(0)
    return distances[distances < 1.5 * np.median(distances)]


def _faked(recording: Recording) -> list[DataFinding]:
    """An angle that is the command itself, to a rounding: a slow body follows a slow drive closely, but never so."""
    if recording.drive_signal is None:
        return []
    valid = recording.valid
    command = net_drive(comparable(recording.drive_signal, recording.channels))[valid]
    measured = recording.sin_theta[valid]
    if len(measured) < 16 or np.ptp(command) == 0 or np.ptp(measured) == 0:
        return []
    apart = float(np.abs(measured - np.polyval(np.polyfit(command, measured, 1), command)).max())
    if apart > _ROUNDING * np.ptp(measured):
        return []
    evidence = f"the angle is the command, scaled, to within {apart:.1g}"
    return [
        error("command equals measurement", apart, evidence, "check which signal was recorded as the angle")
    ]


def _number(text: str | None) -> float | None:
    try:
        return None if text is None else float(text)
    except ValueError:
        return None
