"""Find what was lost in the whole picture: beside the markers that are in view, or all of them at once."""

from collections.abc import Iterable

import numpy as np

from hasel_tracker.tracking.blobs import Blob
from hasel_tracker.tracking.body_link import BodyLink, body_link
from hasel_tracker.tracking.head_order import as_before
from hasel_tracker.tracking.head_side import thicker_first
from hasel_tracker.tracking.marker_finder import MarkerFinder
from hasel_tracker.tracking.marker_measurement import MarkerMeasurement
from hasel_tracker.tracking.marker_memory import MarkerMemory, places
from hasel_tracker.tracking.marker_order import assignments_of_lost
from hasel_tracker.tracking.marker_row import MarkerRow, marker_candidates
from hasel_tracker.tracking.marker_start import whole_frame_blobs

Measured = list[MarkerMeasurement | None]


def links_at(
    image: np.ndarray, positions: np.ndarray, links: Iterable[int], radius_px: float
) -> tuple[BodyLink, ...]:
    """The body between markers (m, 2) [px]; link number k leads from marker k to k + 1."""
    return tuple(body_link(image, positions[each], positions[each + 1], radius_px) for each in links)


def without_strangers(image: np.ndarray, measured: Measured, memory: MarkerMemory) -> Measured:
    """What seems to be a marker that was lost counts only if the body leads to it."""
    back = {n for n, each in enumerate(measured) if each is not None and not memory.seen[n]}
    kept, at = list(measured), places(measured)
    for link in _links_of(back, len(measured)):
        both = np.isfinite(at[link : link + 2]).all()
        if both and not links_at(image, at, [link], memory.radius_px)[0].seen:
            for number in {link, link + 1} & back:
                kept[number] = None
    return kept


def found_beside(
    image: np.ndarray, measured: Measured, memory: MarkerMemory, finder: MarkerFinder, on_body: bool
) -> Measured:
    """The lost ones by the others that are in view, if exactly one choice of blobs fits. on_body: a body must lead
    there too."""
    known = places(measured)
    taken = known[~np.isnan(known[:, 0])]
    radius = np.sqrt(memory.areas.max() / np.pi)
    free = [
        blob
        for blob in marker_candidates(whole_frame_blobs(image, finder.settings))
        if np.linalg.norm(taken - blob.centre, axis=1).min() > 2.0 * radius
    ]
    fitting: list[dict[int, Blob]] = []
    for choice in assignments_of_lost(free, known, memory.last_seen, memory.chords_px, memory.areas):
        trial = known.copy()
        for number, blob in choice.items():
            trial[number] = blob.centre
        links = links_at(image, trial, _links_of(choice, len(trial)) if on_body else (), memory.radius_px)
        if all(link.seen for link in links):
            fitting.append(choice)
        if len(fitting) > 1:
            return measured
    if not fitting:
        return measured
    found = list(measured)
    for number, blob in fitting[0].items():
        found[number] = finder.of_blobs(image, [blob])[0]
    return found


def found_together(
    image: np.ndarray, row: MarkerRow, memory: MarkerMemory, finder: MarkerFinder
) -> Measured | None:
    """All of them after a moment away: the one row in the picture, in the order nearest to the last.

    None where that lies the other way round: it is started anew when the old order is forgotten.
    """
    row = as_before(row, memory.last_seen)
    if thicker_first(row.links) is False:
        return None
    found = finder.of_blobs(image, row.blobs)
    return found if all(found) else None


def _links_of(numbers: Iterable[int], count: int) -> list[int]:
    """The links that end at one of these of `count` markers."""
    return sorted({link for number in numbers for link in (number - 1, number) if 0 <= link < count - 1})
