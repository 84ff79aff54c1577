"""When a drive switched of which a recording knows the rows only: between two of them, or where some are missing."""

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
    """Place the switches that fall between rows.

    A switch from one value to another recurs with the drive's period. Where rows are missing around one, and the seen
    ones say when it was due, and that lies in the gap, it is put there, otherwise it stays at the row after the gap; a
    RecordingWarning says each. Where the distances of the rows show that the drive switches between them, every switch
    is put where the period wants it, as far as the rows tell.
    """
    if recording.drive_signal is None or recording.drive_time_s is not None:
        return recording
    time_s, values = recording.drive()
    changes = 1 + np.flatnonzero(np.any(np.diff(values, axis=0) != 0, axis=1))
    steps = np.diff(time_s)
    if len(steps) == 0 or len(changes) == 0 or len(changes) > SWITCHING * len(steps):
        return recording
    uncertain = steps[changes - 1] > LOST_ROW * float(np.median(steps))
    if uncertain.any():
        placed, said = _in_gaps(recording, time_s, values, changes, uncertain), ()
    else:
        placed, said = _between_rows(time_s, values, changes)
    if np.array_equal(placed, time_s):
        return recording
    kept = slice(None) if recording.ripple else np.concatenate([[0], changes])
    return replace(
        recording,
        drive_time_s=placed[kept],
        drive_values=recording.drive_signal[kept],
        understood=(*recording.understood, *said),
    )


def _in_gaps(
    recording: Recording, time_s: np.ndarray, values: np.ndarray, changes: np.ndarray, uncertain: np.ndarray
) -> np.ndarray:
    """Times of the rows [s] [n], those of the uncertain changes where they were due."""
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
        warnings.warn(f"{recording.path or recording.name}: {said}", RecordingWarning, stacklevel=4)
    return placed


def _between_rows(
    time_s: np.ndarray, values: np.ndarray, changes: np.ndarray
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Times of the rows [s] [n], those of the changes where a period puts them, and a sentence that says so.

    All switches are equally spaced, or else those between the same two values. The rows stay where no period puts every
    switch after the row before it, or all distances are alike, as of a drive that switches with the rows.
    """
    seen, before = time_s[changes], time_s[changes - 1]
    frame = float(np.median(np.diff(time_s)))
    kinds = [values[row - 1 : row + 1].tobytes() for row in changes]
    for which in (np.zeros(len(seen), dtype=int), np.array([kinds.index(kind) for kind in kinds])):
        apart = np.concatenate([np.diff(seen[which == kind]) for kind in np.unique(which)])
        if len(apart) < 2 or not 0.5 * frame < np.ptp(apart) < LOST_ROW * frame:
            continue
        found = _equally_spaced(before, seen, which, float(apart.mean()))
        if found is not None:
            placed = time_s.copy()
            placed[changes], spacing = found
            said = f"the drive switches between rows; each switch is placed there by its spacing of {spacing:.6g} s"
            return placed, (said,)
    return time_s, ()


def _equally_spaced(
    before: np.ndarray, after: np.ndarray, which: np.ndarray, about: float
) -> tuple[np.ndarray, float] | None:
    """Instants [s] within these [n] at which one spacing, `about` so large, puts them from a first one of every kind
    on, and the spacing: in the middle of all that do so (Chebyshev centre). None where none does.
    """
    from scipy.optimize import linprog  # takes a while, and few drives need it

    each = np.unique(which)
    first = np.array([after[which == kind][0] for kind in which])
    where = np.column_stack([which[:, None] == each, np.round((after - first) / about)]).astype(float)
    within = np.column_stack([np.vstack([where, -where]), np.ones(2 * len(after))])
    bounds = [(None, None)] * where.shape[1] + [(0.0, None)]
    wanted = np.append(np.zeros(where.shape[1]), -1.0)
    found = linprog(wanted, within, np.concatenate([after, -before]), bounds=bounds)
    return (where @ found.x[:-1], float(found.x[-2])) if found.status == 0 else None


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
