"""The default method: colour says which blobs are markers, luma moments in predicted regions say where."""

import numpy as np

from hasel_tracker.tracking.blobs import Blob, blobs_in_frame, nearest_outline
from hasel_tracker.tracking.head_side import starts_at_head
from hasel_tracker.tracking.marker_moment import RING_WIDTH_PX, MarkerMeasurement, measure_marker
from hasel_tracker.tracking.marker_order import CHORD_TOLERANCE, assign_lost, body_line
from hasel_tracker.tracking.marker_set import MarkerSet
from hasel_tracker.tracking.tracker_settings import TrackerSettings

WIDER_REGION = 3
FORGET_AFTER_S = 1.0
AREA_MEMORY = 0.02
AREA_MEMORY_IN_DOUBT = 0.005
RADIUS_TOLERANCE_PX = 0.7
CHORD_MEMORY = 0.02
NOISE_AT_HALF_QUALITY = 0.25


class MomentTracker:
    """Follows three markers from frame to frame; finds them by itself at the start and when lost."""

    def __init__(self, settings: TrackerSettings = TrackerSettings()) -> None:  # noqa: B008
        self.settings = settings
        self.note = ""
        self._positions = np.full((3, 2), np.nan)
        self._velocities = np.zeros((3, 2))
        self._last_seen = np.full((3, 2), np.nan)
        self._areas = np.zeros(3)
        self._chords: np.ndarray | None = None
        self._time_s = np.nan
        self._seen_s = np.nan

    def update(self, image: np.ndarray, time_s: float) -> MarkerSet:
        """Markers in an 8-bit BGR image taken at `time_s`; nothing is carried over from an earlier frame."""
        # What comes back after a while may lie the other way round: head and tail are told apart anew.
        forgotten = time_s - self._seen_s > FORGET_AFTER_S
        if (self._chords is None or forgotten) and not self._start(image):
            return MarkerSet.lost()
        step_s = time_s - self._time_s if np.isfinite(self._time_s) else 0.0
        predicted = self._positions + self._velocities * step_s
        measured = [self._follow(image, number, predicted[number]) for number in range(3)]
        measured = self._reacquire(image, measured)
        return self._accept(measured, time_s, step_s)

    @property
    def radius_px(self) -> float:
        """Radius of the markers as followed so far [px]; 0 before the start."""
        return float(np.sqrt(np.median(self._areas) / np.pi))

    def _start(self, image: np.ndarray) -> bool:
        blobs = self._candidates(image)
        row = body_line(blobs)
        if row is None:
            self.note = (
                f"found {len(blobs)} blobs of marker colour, of which no three look like markers in a row"
            )
            return False
        centres = np.array([blobs[index].centre for index in row])
        first_is_head, self.note = starts_at_head(image, centres, self.settings.head)
        order = row if first_is_head else row[::-1]
        self._positions = np.array([blobs[index].centre for index in order])
        self._last_seen = self._positions.copy()
        self._velocities[:] = 0.0
        self._chords = np.linalg.norm(np.diff(self._positions, axis=0), axis=1)
        for number, blob in enumerate(blobs[index] for index in order):
            found = self._measure(image, blob.centre, blob.area, self.settings.region_px)
            self._areas[number] = blob.area if found is None else found.area
        return True

    def _candidates(self, image: np.ndarray) -> list[Blob]:
        settings = self.settings
        radius = settings.marker_radius_px or settings.smallest_radius_px
        step = int(np.clip(0.5 * radius, 1, 4))
        found = blobs_in_frame(image, settings.colour, step, 0.7 * radius)
        largest = 1.5 * settings.marker_radius_px or settings.largest_radius_px
        return [blob for blob in found if blob.radius <= largest]

    def _follow(self, image: np.ndarray, number: int, predicted: np.ndarray) -> MarkerMeasurement | None:
        if np.isnan(predicted[0]):
            return None
        for margin in (self.settings.region_px, WIDER_REGION * self.settings.region_px):
            measurement = self._measure(image, predicted, self._areas[number], margin)
            if measurement is not None:
                return measurement
        return None

    def _measure(
        self, image: np.ndarray, predicted: np.ndarray, area: float, margin: int
    ) -> MarkerMeasurement | None:
        radius = np.sqrt(area / np.pi)
        reach = int(radius + self.settings.edge_px + RING_WIDTH_PX + 2 + margin)
        left, top = np.rint(predicted).astype(int) - reach
        right, bottom = left + 2 * reach + 1, top + 2 * reach + 1
        left, top = max(left, 0), max(top, 0)
        region = image[top : max(bottom, 0), left : max(right, 0)]
        if min(region.shape[:2]) < 2 * radius:
            return None
        mask = self.settings.colour.mask(region)
        outline = nearest_outline(mask, predicted - [left, top], area)
        if outline is None:
            return None
        measurement = measure_marker(region, outline, self.settings.edge_px)
        if measurement is None:
            return None
        return measurement.moved_by(np.array([left, top], float))

    def _reacquire(
        self, image: np.ndarray, measured: list[MarkerMeasurement | None]
    ) -> list[MarkerMeasurement | None]:
        if all(measured):
            return measured
        known = np.array([np.full(2, np.nan) if each is None else each.centre for each in measured])
        taken = known[~np.isnan(known[:, 0])]
        radius = np.sqrt(self._areas.max() / np.pi)
        free = [
            blob
            for blob in self._candidates(image)
            if not len(taken) or np.linalg.norm(taken - blob.centre, axis=1).min() > 2.0 * radius
        ]
        for number, blob in assign_lost(free, known, self._last_seen, self._chords, self._areas).items():
            measured[number] = self._measure(image, blob.centre, blob.area, self.settings.region_px)
        return measured

    def _accept(self, measured: list[MarkerMeasurement | None], time_s: float, step_s: float) -> MarkerSet:
        before = self._positions
        quality = np.array(
            [0.0 if m is None else self._quality(m, self._areas[n]) for n, m in enumerate(measured)]
        )
        positions = np.array([np.full(2, np.nan) if m is None else m.centre for m in measured])
        positions[quality < self.settings.minimum_quality] = np.nan
        markers = self._plausible(MarkerSet(positions, np.where(np.isnan(positions[:, 0]), 0.0, quality)))
        found = markers.found
        moved = (markers.positions - before) / step_s if step_s > 0.0 else np.zeros((3, 2))
        self._velocities = np.where(np.isfinite(moved), moved, 0.0)
        self._positions = markers.positions
        self._last_seen[found] = markers.positions[found]
        self._time_s = time_s
        self._seen_s = time_s if found.any() else self._seen_s
        for number, measurement in enumerate(measured):
            if measurement is not None:
                memory = AREA_MEMORY if found[number] else AREA_MEMORY_IN_DOUBT
                self._areas[number] += memory * (measurement.area - self._areas[number])
        if found.all():
            chords = np.linalg.norm(np.diff(markers.positions, axis=0), axis=1)
            self._chords = self._chords + CHORD_MEMORY * (chords - self._chords)
        return markers

    def _plausible(self, markers: MarkerSet) -> MarkerSet:
        """Drop an end marker that is nowhere near its distance from the middle one."""
        chords = np.linalg.norm(np.diff(markers.positions, axis=0), axis=1)
        wrong = np.abs(chords / self._chords - 1.0) > 1.5 * CHORD_TOLERANCE
        if not wrong.any():
            return markers
        positions, quality = markers.positions.copy(), markers.quality.copy()
        dropped = [1] if wrong.all() else [0 if wrong[0] else 2]
        positions[dropped], quality[dropped] = np.nan, 0.0
        return MarkerSet(positions, quality)

    @staticmethod
    def _quality(measurement: MarkerMeasurement, area: float) -> float:
        """One for a full, clear marker; less for one that is cut, merged with something, or noisy."""
        wider_px = (np.sqrt(measurement.area) - np.sqrt(area)) / np.sqrt(np.pi)
        size = np.exp(-((wider_px / RADIUS_TOLERANCE_PX) ** 2))
        noise = measurement.noise / max(measurement.contrast, 1e-9)
        clear = 1.0 / (1.0 + (noise / NOISE_AT_HALF_QUALITY) ** 2)
        return float(np.clip(size * measurement.solidity * clear, 0.0, 1.0))
