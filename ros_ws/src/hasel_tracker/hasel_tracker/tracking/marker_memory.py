# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is known of the markers from the frames so far, which things measured are they, and what gives rise to doubt."""

from collections.abc import Sequence

import numpy as np

from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker.tracking.marker_set import MarkerMeasurement

EXTRAPOLATED_FRAMES = 2
REACH_MEMORY = 0.98
REACH_SHARE_OF_CHORD = 0.4
AREA_MEMORY = 0.02
CHORD_MEMORY = 0.02
CHORD_TOLERANCE = (
    0.1  # a body that keeps its length and turns by 100° shortens its chords by 3 %; the rest is perspective
)
RADIUS_TOLERANCE_PX, RADIUS_TOLERANCE = 0.7, 0.05


def places(measured: Sequence[MarkerMeasurement | None]) -> np.ndarray:
    """Centres (m, 2) [px]; NaN where there is none."""
    return np.array([np.full(2, np.nan) if each is None else each.centre for each in measured])


class MarkerMemory:
    """Of m markers seen together at `time_s`. All arrays are (m,) or (m, 2), chords_px is (m - 1,) [px].

    last_seen: where each was when it was seen last; seen: which were in the frame before; reach_px: how far from its
    prediction a marker of this body may be, by how well it was predicted lately.
    """

    def __init__(self, measured: Sequence[MarkerMeasurement], time_s: float, region_px: float) -> None:
        self.last_seen = places(measured)
        self.seen = np.ones(len(measured), bool)
        self.seen_at_s = np.full(len(measured), time_s)
        self.time_s = time_s
        self.areas = np.array([each.area for each in measured])
        self.chords_px = np.linalg.norm(np.diff(self.last_seen, axis=0), axis=1)
        self.reach_px = self._region_px = float(region_px)
        self._velocities = np.zeros((len(measured), 2))

    @property
    def radius_px(self) -> float:
        """The markers' radius [px]."""
        return float(np.sqrt(np.median(self.areas) / np.pi))

    def predicted(self, time_s: float) -> np.ndarray:
        """Where the markers should be (m, 2) [px]; one that was not seen lately stays where it went."""
        since_s = np.minimum(time_s - self.seen_at_s, EXTRAPOLATED_FRAMES * (time_s - self.time_s))
        return self.last_seen + self._velocities * since_s[:, None]

    def remember(
        self, positions: np.ndarray, areas: np.ndarray, predicted: np.ndarray, time_s: float, sure: bool
    ) -> None:
        """Take in a frame: positions (m, 2), NaN where not seen. sure: sizes and distances may be learned too."""
        seen = np.isfinite(positions[:, 0])
        since_s = time_s - self.seen_at_s
        moved = (positions - self.last_seen) / np.where(since_s > 0.0, since_s, 1.0)[:, None]
        self._velocities = np.where(np.isfinite(moved) & (since_s > 0.0)[:, None], moved, self._velocities)
        residual = np.linalg.norm(positions - predicted, axis=1)[seen].max(initial=0.0)
        usual = max(self._region_px, 2.0 * residual, REACH_MEMORY * self.reach_px)
        usual = min(usual, REACH_SHARE_OF_CHORD * float(self.chords_px.min()))
        self.reach_px = max(usual, self._region_px)
        self.last_seen[seen], self.seen_at_s[seen] = positions[seen], time_s
        self.seen, self.time_s = seen, time_s
        if sure and seen.all():
            self.areas = self.areas + AREA_MEMORY * (areas - self.areas)
            chords = np.linalg.norm(np.diff(positions, axis=0), axis=1)
            self.chords_px = self.chords_px + CHORD_MEMORY * (chords - self.chords_px)


def quality(measurement: MarkerMeasurement, area: float, radius_px: float) -> float:
    """One for a full, clear marker of its `area` [px²]; less for one that is cut, merged with something, or noisy."""
    wider_px = (np.sqrt(measurement.area) - np.sqrt(area)) / np.sqrt(np.pi)
    size = np.exp(-((wider_px / max(RADIUS_TOLERANCE_PX, RADIUS_TOLERANCE * radius_px)) ** 2))
    return float(np.clip(size * measurement.solidity * measurement.clarity, 0.0, 1.0))


def qualities(measured: Sequence[MarkerMeasurement | None], memory: MarkerMemory) -> np.ndarray:
    """Quality of each marker (m,); 0 where there is none."""
    radius_px = memory.radius_px
    return np.array(
        [
            0.0 if each is None else quality(each, area, radius_px)
            for each, area in zip(measured, memory.areas, strict=True)
        ]
    )


def accepted(
    measured: Sequence[MarkerMeasurement | None],
    predicted: np.ndarray,
    memory: MarkerMemory,
    minimum_quality: float,
) -> np.ndarray:
    """Which markers count as seen (m,): clear enough, and at their distance from each other."""
    good = np.array([each is not None for each in measured]) & (
        qualities(measured, memory) >= minimum_quality
    )
    positions = np.where(good[:, None], places(measured), np.nan)
    residual = np.linalg.norm(positions - predicted, axis=1)
    return good & ~misplaced(positions, residual, memory.chords_px)


def event(positions: np.ndarray, predicted: np.ndarray, memory: MarkerMemory, rivals: bool) -> Doubt:
    """What happened in this frame: positions (m, 2) [px], NaN where not seen; rivals: something like a marker is
    about as near as one."""
    if rivals:
        return Doubt.AMBIGUOUS
    seen = np.isfinite(positions[:, 0])
    if (seen & ~memory.seen).any():
        return Doubt.FOUND_AGAIN
    apart = np.linalg.norm(positions - predicted, axis=1)[seen].max(initial=0.0)
    return Doubt.JUMP if apart > memory.reach_px else Doubt.NONE


def misplaced(positions: np.ndarray, residual_px: np.ndarray, chords: np.ndarray) -> np.ndarray:
    """Which markers (m,) are nowhere near their distance from their neighbours.

    positions: (m, 2) [px]; residual_px: (m,) how far each is from where it was predicted; chords: (m - 1,) [px].
    """
    wrong = np.abs(np.linalg.norm(np.diff(positions, axis=0), axis=1) / chords - 1.0) > CHORD_TOLERANCE
    blame = np.zeros(len(positions), bool)
    for number in np.flatnonzero(wrong):
        first, last = number, number + 1
        if blame[first] or blame[last]:
            continue
        votes = [_wrong_chords(wrong, each) for each in (first, last)]
        if votes[0] != votes[1]:
            blame[first if votes[0] > votes[1] else last] = True
        else:
            blame[
                first if np.nan_to_num(residual_px[first]) >= np.nan_to_num(residual_px[last]) else last
            ] = True
    return blame


def _wrong_chords(wrong: np.ndarray, marker: int | np.integer) -> float:
    """Share of a marker's chords that are wrong."""
    return float(wrong[max(marker - 1, 0) : marker + 1].mean())
