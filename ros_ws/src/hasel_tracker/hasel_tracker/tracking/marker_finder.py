"""Find one marker near a place in a picture, and measure it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from hasel_tracker.tracking.blobs import Blob, BlobOutline, nearest_outline
from hasel_tracker.tracking.marker_contour import OUTSIDE_PX
from hasel_tracker.tracking.marker_measurement import MarkerMeasurement
from hasel_tracker.tracking.tracker_settings import TrackerSettings

Measure = Callable[[np.ndarray, np.ndarray, int], MarkerMeasurement | None]

SPARE_PX = 4


@dataclass(frozen=True)
class MarkerFinder:
    """Looks for marker colour as `settings` says and locates it with `measure_within` its outline."""

    settings: TrackerSettings
    measure_within: Measure

    def for_light_of(self, image: np.ndarray) -> "MarkerFinder":
        """The same with the marker's colour as it is in this picture's light."""
        return replace(self, settings=replace(self.settings, colour=self.settings.colour.for_light_of(image)))

    def near(
        self, image: np.ndarray, place: np.ndarray, area: float, margin_px: float
    ) -> tuple[MarkerMeasurement | None, BlobOutline | None]:
        """The marker of about `area` [px²] nearest to `place` (2,), if there is one in reach."""
        radius = np.sqrt(area / np.pi)
        reach = int(radius + self.settings.edge_px + OUTSIDE_PX + SPARE_PX + int(margin_px))
        left, top = np.rint(place).astype(int) - reach
        right, bottom = left + 2 * reach + 1, top + 2 * reach + 1
        left, top = max(left, 0), max(top, 0)
        region = image[top : max(bottom, 0), left : max(right, 0)]
        if min(region.shape[:2]) < 2 * radius:
            return None, None
        outline = nearest_outline(self.settings.colour.mask(region), place - [left, top], area)
        if outline is None:
            return None, None
        measurement = self.measure_within(region, outline.contour, self.settings.edge_px)
        if measurement is None:
            return None, None
        return measurement.moved_by(np.array([left, top], float)), outline

    def of_blobs(self, image: np.ndarray, blobs: Sequence[Blob]) -> list[MarkerMeasurement | None]:
        """Each blob measured as a marker; None where its edge is not clear."""
        return [self.near(image, blob.centre, blob.area, self.settings.region_px)[0] for blob in blobs]
