"""Which of the things that were measured are the markers, and what about a frame gives rise to doubt."""

from collections.abc import Sequence

import numpy as np

from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker.tracking.marker_measurement import MarkerMeasurement
from hasel_tracker.tracking.marker_memory import MarkerMemory, places
from hasel_tracker.tracking.marker_order import misplaced

RADIUS_TOLERANCE_PX, RADIUS_TOLERANCE = 0.7, 0.05


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
