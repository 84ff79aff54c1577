"""When a drive switched, where rows around the switch are missing or farther apart than usual."""

import warnings
from dataclasses import replace

import numpy as np

from hasel_recording.errors import RecordingWarning
from hasel_recording.recording import Recording

LOST_ROW = 1.5
"""Rows farther apart than this many usual distances have others missing between them."""

SWITCHING = 0.5
"""A drive that changes at more than this share of the rows is a waveform, not one that switches."""


def with_placed_switches(recording: Recording) -> Recording:
    """Place the switches that fall between rows with others missing; a RecordingWarning says each.

    A switch from one value to another recurs with the drive's period; where the instants of the seen ones say when it
    was due, and that lies in the gap, it is put there, otherwise it stays at the row after the gap.
    """
    if recording.drive_signal is None or recording.drive_time_s is not None:
        return recording
    time_s, values = recording.drive()
    changes = 1 + np.flatnonzero(np.any(np.diff(values, axis=0) != 0, axis=1))
    steps = np.diff(time_s)
    if len(steps) == 0 or len(changes) == 0 or len(changes) > SWITCHING * len(steps):
        return recording
    uncertain = steps[changes - 1] > LOST_ROW * float(np.median(steps))
    if not uncertain.any():
        return recording
    placed = time_s.copy()
    for row in changes[uncertain]:
        before, after = float(time_s[row - 1]), float(time_s[row])
        due, period = _due(time_s, values, changes[~uncertain], row)
        gap = f"the drive switches between the rows at {before:g} and {after:g} s, farther apart than usual"
        if due is None:
            said = (
                f"{gap}; it is taken to switch at {after:g} s: give its own file with --drive to know better."
            )
        else:
            placed[row] = due
            said = f"{gap}; the switch is placed at {due:.6g} s by the drive's period of {period:.6g} s."
        warnings.warn(f"{recording.path or recording.name}: {said}", RecordingWarning, stacklevel=3)
    if np.array_equal(placed, time_s):
        return recording
    kept = slice(None) if recording.ripple else np.concatenate([[0], changes])
    return replace(recording, drive_time_s=placed[kept], drive_values=recording.drive_signal[kept])


def _due(
    time_s: np.ndarray, values: np.ndarray, sharp: np.ndarray, row: int
) -> tuple[float | None, float | None]:
    """When the switch seen at `row` was due by the `sharp` rows, and the period; None where they do not tell.

    First by the switches between the same two values, which recur whatever the waveform; then by all of them, which
    are equally spaced where both halves of the cycle last alike.
    """
    frame = float(np.median(np.diff(time_s)))
    kinds: dict[bytes, list[float]] = {}
    for other in sharp:
        kinds.setdefault(values[other - 1 : other + 1].tobytes(), []).append(float(time_s[other]))
    periods = [fit[0] for seen in kinds.values() if (fit := _spacing(np.array(seen), frame))]
    same = np.array(kinds.get(values[row - 1 : row + 1].tobytes(), []))
    for seen, period in ((same, min(periods, default=None)), (time_s[sharp], None)):
        fit = _spacing(seen, frame, period)
        if fit is not None:
            period, start = fit
            due = start + period * np.round((0.5 * (time_s[row - 1] + time_s[row]) - start) / period)
            if time_s[row - 1] < due <= time_s[row] + 1e-9:
                return float(due), float(period)
    return None, None


def _spacing(seen: np.ndarray, frame: float, period: float | None = None) -> tuple[float, float] | None:
    """Period and first of instants [s], equally spaced to a `frame`, some perhaps unseen; None where they are not.

    period: where it is known from elsewhere; otherwise two neighbours must be among them.
    """
    if len(seen) < (2 if period is None else 1):
        return None
    period, start = float(np.diff(seen).min()) if period is None else period, float(seen[0])
    for _ in range(2):  # with the shortest distance, then with the mean one
        count = np.round((seen - start) / period)
        if count[-1] > count[0]:
            period, start = np.polyfit(count, seen, 1)
    off = float(np.abs(seen - start - count * period).max())
    return (float(period), float(start)) if off <= frame else None
