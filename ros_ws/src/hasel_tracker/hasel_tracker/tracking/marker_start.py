"""Find the markers in one picture with nothing known but what they look like, or refuse and say why."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import cv2
import numpy as np

from hasel_tracker.tracking.blobs import Blob, blobs_in_frame
from hasel_tracker.tracking.body_link import BodyLink, body_link
from hasel_tracker.tracking.body_row import crowd, misfit
from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker.tracking.marker_row import MarkerRow, marker_candidates, rival_near, rows_on_a_body
from hasel_tracker.tracking.tracker_settings import TrackerSettings

WORDS = (
    "two three four five six seven eight nine ten eleven twelve thirteen fourteen fifteen".split()  # noqa: SIM905
)
NUMBERS = dict(enumerate(WORDS, start=2))
DARK_PICTURE = 60.0
FEW_LINKS = 12
ADVICE = (
    "point at the right ones with --at, look only within a part of the picture with --roi, or say how many there are "
    "with --markers"
)


@dataclass(frozen=True)
class StartSearch:
    """What one picture gives: a row (either end first) if there is exactly one, else why not. links: looked at."""

    row: MarkerRow | None
    doubt: Doubt
    note: str
    links: int


def whole_frame_blobs(image: np.ndarray, settings: TrackerSettings) -> list[Blob]:
    """Blobs of marker colour of a size that a marker may have, in full pixels, from every few pixels of the image."""
    radius = settings.marker_radius_px or settings.smallest_radius_px
    step = int(np.clip(0.5 * radius, 1, 4))
    found = blobs_in_frame(image, settings.colour, step, 0.7 * radius)
    largest = 1.5 * settings.marker_radius_px or settings.largest_radius_px
    return [blob for blob in found if blob.radius <= largest]


def search_start(image: np.ndarray, settings: TrackerSettings, whole: bool = True) -> StartSearch:
    """Look for the one row of markers with a body between them. whole: they lie on its axis, out to its ends."""
    settings = replace(settings, colour=settings.colour.for_light_of(image))
    blobs = whole_frame_blobs(image, settings)
    candidates = marker_candidates(blobs)
    looked: list[BodyLink] = []

    def link(first: Blob, last: Blob) -> BodyLink:
        looked.append(body_link(image, first.centre, last.centre, 0.5 * (first.radius + last.radius)))
        return looked[-1]

    count, distances = settings.marker_count, settings.distances
    rows = rows_on_a_body(candidates, count, link, distances=distances)
    word = NUMBERS[settings.marker_count]
    if len(rows) == 1 and _has_rival(rows[0], blobs, link):
        note = "another blob of marker colour lies so near a marker that it may be the marker; " + ADVICE
        return StartSearch(None, Doubt.AMBIGUOUS, note, len(looked))
    if len(rows) == 1:
        why = _why_not(image, rows[0], whole)
        if why:
            return StartSearch(None, Doubt.AMBIGUOUS, f"{why}; {ADVICE}", len(looked))
        return StartSearch(rows[0], Doubt.NONE, "", len(looked))
    if rows:
        note = f"more than one row of {word} dots lies on a body ({len(candidates)} dots seen); {ADVICE}"
        return StartSearch(None, Doubt.AMBIGUOUS, note, len(looked))
    note = (
        f"found {len(blobs)} blobs of marker colour, of which no {word} look like markers in a row on a body"
    )
    uneven = rows_on_a_body(candidates, count, link, 1) if len(looked) < FEW_LINKS else []
    if uneven:
        apart = np.linalg.norm(np.diff(uneven[0].centres, axis=0), axis=1)
        seen, said = ", ".join(f"{each:.0f}" for each in apart), settings.spacing or "even"
        note = (
            f"{word} dots lie on a body, {seen} px from each other, where the spacing is {said}: a marker may be out "
            "of sight; if they are the markers, point at them with --at, also in `calibrate colour`, which learns the "
            "spacing"
        )
    if cv2.mean(image[::8, ::8])[1] < DARK_PICTURE:
        note += "; the picture is dark: learn the colour with `calibrate colour --at`"
    return StartSearch(None, Doubt.NONE, note, len(looked))


def _has_rival(row: MarkerRow, blobs: list[Blob], link: Callable[[Blob, Blob], BodyLink]) -> bool:
    area = float(np.median([blob.area for blob in row.blobs]))
    return rival_near(blobs, row.centres, range(len(row.blobs)), area, link)


def _why_not(image: np.ndarray, row: MarkerRow, whole: bool) -> str:
    radius = float(np.median([blob.radius for blob in row.blobs]))
    return crowd(row.links, radius) or (misfit(image, row.centres, row.links, radius) if whole else "")
