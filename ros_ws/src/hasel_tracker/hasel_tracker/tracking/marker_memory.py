"""What is known of the markers from the frames so far: places, speeds, sizes and distances."""

from collections.abc import Sequence

import numpy as np

from hasel_tracker.tracking.marker_measurement import MarkerMeasurement

EXTRAPOLATED_FRAMES = 2
REACH_MEMORY = 0.98
REACH_SHARE_OF_CHORD = 0.4
AREA_MEMORY = 0.02
CHORD_MEMORY = 0.02


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
