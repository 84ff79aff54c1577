# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Find markers in a whole picture: a row of which nothing is known but its looks, or what was lost of one."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from itertools import permutations

import cv2
import numpy as np

from hasel_tracker.tracking.body_link import BodyLink, body_link
from hasel_tracker.tracking.body_row import crowd, misfit
from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker.tracking.head_order import as_before, thicker_first
from hasel_tracker.tracking.marker_finder import Blob, MarkerFinder, blobs_in_frame
from hasel_tracker.tracking.marker_memory import CHORD_TOLERANCE, MarkerMemory, places
from hasel_tracker.tracking.marker_row import MarkerRow, marker_candidates, rival_near, rows_on_a_body
from hasel_tracker.tracking.marker_set import MarkerMeasurement
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
Measured = list[MarkerMeasurement | None]
MOST_CANDIDATES = 8
MOST_LOST = 2
LARGEST_AREA_RATIO = 2.0
LARGEST_TURN_RAD = 2.1


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


def assignments_of_lost(
    blobs: list[Blob], known: np.ndarray, expected: np.ndarray, chords: np.ndarray, areas: np.ndarray
) -> list[dict[int, Blob]]:
    """Ways to give the lost markers blobs so that the distances along the body stay what they were, best first.

    known: (m, 2) with NaN for lost markers [px]; expected: (m, 2) where each was last seen; chords: (m - 1,) distances
    from marker to marker [px]; areas: (m,) [px²]. Marker number → blob; empty if nothing fits, or more are lost than
    their neighbours can vouch for.
    """
    lost = np.flatnonzero(np.isnan(known[:, 0]))
    if len(lost) > MOST_LOST or len(lost) == len(known):
        return []
    near = 0.1 * chords.sum()
    # Those far from every place where a lost marker may be are not worth a try.
    tried = sorted(blobs, key=lambda blob: np.linalg.norm(expected[lost] - blob.centre, axis=1).min())
    found = []
    for choice in permutations(tried[:MOST_CANDIDATES], len(lost)):
        trial = known.copy()
        trial[lost] = [blob.centre for blob in choice]
        steps = np.diff(trial, axis=0)
        stretch = np.linalg.norm(steps, axis=1) / chords - 1.0
        unlike = np.log([blob.area / areas[number] for blob, number in zip(choice, lost, strict=True)])
        if np.abs(stretch).max() > CHORD_TOLERANCE or np.abs(unlike).max() > np.log(LARGEST_AREA_RATIO):
            continue
        if _sharpest_turn(steps) > LARGEST_TURN_RAD:
            continue
        jump = (trial[lost] - expected[lost]) / near
        cost = (stretch @ stretch) / 0.05**2 + (unlike @ unlike) / 0.3**2 + (jump**2).sum()
        found.append((float(cost), {int(number): blob for number, blob in zip(lost, choice, strict=True)}))
    return [assignment for _, assignment in sorted(found, key=lambda each: each[0])]


def _sharpest_turn(steps: np.ndarray) -> float:
    if len(steps) < 2:
        return 0.0
    along = np.unwrap(np.arctan2(steps[:, 1], steps[:, 0]))
    return float(np.abs(np.diff(along)).max())
