# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""When a drive switched of which a recording knows the rows only: between two of them, or where some are missing."""

from dataclasses import replace

import numpy as np

from hasel_recording.errors import warn
from hasel_recording.recording import Recording

LOST_ROW = 1.5
"""Rows farther apart than this many usual distances have others missing between them."""

SWITCHING = 0.5
"""A drive that changes at more than this share of the rows is a waveform, not one that switches."""

NEIGHBOURS = 1.6
"""Switches farther apart than this many times the shortest distance have others unseen between them."""


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
    from_to = [values[row - 1 : row + 1].tobytes() for row in changes]
    kinds = np.array([from_to.index(each) for each in from_to])
    before, seen, frame = time_s[changes - 1], time_s[changes], float(np.median(steps))
    if np.any(seen - before > LOST_ROW * frame):
        placed, said = _in_gaps(recording, before, seen, kinds, frame), ()
    else:
        placed, said = _between_rows(before, seen, kinds, frame)
    if np.array_equal(placed, seen):
        return recording
    instants = time_s.copy()
    instants[changes] = placed
    kept = slice(None) if recording.ripple else np.append(0, changes)
    return replace(
        recording,
        drive_time_s=instants[kept],
        drive_values=recording.drive_signal[kept],
        understood=(*recording.understood, *said),
    )


def _in_gaps(
    recording: Recording, before: np.ndarray, seen: np.ndarray, kinds: np.ndarray, frame: float
) -> np.ndarray:
    """Instants of the switches [s] [n]: those in gaps where the others say that they were due, the others as seen.

    First by the switches between the same two values, which recur whatever the waveform, alone or with one period of
    all kinds; then by all of them, which are equally spaced where both halves of the cycle last alike.
    """
    placed, sharp = seen.copy(), seen - before <= LOST_ROW * frame
    for n in np.flatnonzero(~sharp):
        gap = f"the drive switches between the rows at {before[n]:g} and {seen[n]:g} s, farther apart than usual"
        said = (
            f"{gap}; it is taken to switch at {seen[n]:g} s: give its own file with --drive to know better."
        )
        alike = sharp & (kinds == kinds[n])
        for chosen, which in ((alike, kinds), (sharp, kinds), (sharp, np.full_like(kinds, kinds[n]))):
            period, first = _equally_spaced(seen[chosen] - frame, seen[chosen] + frame, which[chosen])
            due = _nearest(0.5 * (before[n] + seen[n]), first.get(kinds[n], np.nan), period)
            if before[n] < due <= seen[n] + 1e-9:
                placed[n] = due
                said = f"{gap}; the switch is placed at {due:.6g} s by the drive's period of {period:.6g} s."
                break
        warn(f"{recording.path or recording.name}: {said}")
    return placed


def _between_rows(
    before: np.ndarray, seen: np.ndarray, kinds: np.ndarray, frame: float
) -> tuple[np.ndarray, tuple[str, ...]]:
    """Instants of the switches [s] [n], where a period puts them between two rows, and a sentence that says so.

    All switches are equally spaced, or else those between the same two values. They stay where no period puts every
    switch after the row before it, or all distances are alike, as of a drive that switches with the rows.
    """
    for which in (np.zeros_like(kinds), kinds):
        apart = _apart(seen, which)
        if len(apart) < 2 or not 0.5 * frame < np.ptp(apart) < LOST_ROW * frame:
            continue
        spacing, first = _equally_spaced(before, seen, which)
        if first:
            placed = _nearest(0.5 * (before + seen), np.array([first[kind] for kind in which]), spacing)
            said = f"the drive switches between rows; each switch is placed there by its spacing of {spacing:.6g} s"
            return placed, (said,)
    return seen, ()


def _equally_spaced(
    earliest: np.ndarray, latest: np.ndarray, which: np.ndarray
) -> tuple[float, dict[int, float]]:
    """The one spacing [s] that puts an instant between every earliest and latest one [n], from a first one of every
    kind on, and these: in the middle of all that do so (Chebyshev centre). No first ones where none does.
    """
    apart = _apart(latest, which)
    if len(apart) == 0:
        return np.nan, {}
    from scipy.optimize import linprog  # takes a while, and few drives need it

    about = apart[apart < NEIGHBOURS * apart.min()].mean()
    each = np.unique(which)
    start = np.array([latest[which == kind][0] for kind in which])
    where = np.column_stack([which[:, None] == each, np.round((latest - start) / about)]).astype(float)
    within = np.column_stack([np.vstack([where, -where]), np.ones(2 * len(latest))])
    bounds = [(None, None)] * where.shape[1] + [(0.0, None)]
    wanted = np.append(np.zeros(where.shape[1]), -1.0)
    found = linprog(wanted, within, np.concatenate([latest, -earliest]), bounds=bounds)
    if found.status != 0:
        return np.nan, {}
    *first, spacing, _ = found.x.tolist()
    return spacing, dict(zip(each.tolist(), first, strict=True))


def _apart(instants: np.ndarray, which: np.ndarray) -> np.ndarray:
    """Distances of the instants of one kind."""
    return np.concatenate([[], *(np.diff(instants[which == kind]) for kind in np.unique(which))])


def _nearest(instants: np.ndarray, first: np.ndarray | float, spacing: float) -> np.ndarray:
    """Of the instants from a first one on, those nearest to these."""
    return first + spacing * np.round((instants - first) / spacing)
