# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Follow the markers from frame to frame; find them at the start and when lost; say when that is in doubt."""

from dataclasses import replace
from typing import Any

import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.body_link import BodyLink, body_link
from hasel_tracker.tracking.body_row import misfit
from hasel_tracker.tracking.body_watch import BodyWatch
from hasel_tracker.tracking.doubt import Doubt, Trust
from hasel_tracker.tracking.head_order import HeadOrder, as_before
from hasel_tracker.tracking.marker_finder import Blob, MarkerFinder, Measure
from hasel_tracker.tracking.marker_memory import MarkerMemory, accepted, event, places, qualities
from hasel_tracker.tracking.marker_row import rival_near
from hasel_tracker.tracking.marker_search import (
    Measured,
    StartSearch,
    found_beside,
    found_together,
    links_at,
    search_start,
    whole_frame_blobs,
    without_strangers,
)
from hasel_tracker.tracking.marker_set import MarkerSet
from hasel_tracker.tracking.tracker_settings import TrackerSettings

WIDER_REGION, WIDER_REACH = 3, 1.5
RIVAL_SHARE = 0.5
FORGET_AFTER_S = 1.0
LOOK_EVERYWHERE_AFTER_S = 0.3
SEARCH_PERIOD_S = 0.1
CHEAP_SEARCH_LINKS = 8
MISSED_RADII, MISSED_PX = 0.5, 5.0


class MarkerTracker:
    """Follows `settings.marker_count` markers that `measure` locates within their outlines."""

    def __init__(self, settings: TrackerSettings, measure: Measure) -> None:
        self.settings = settings
        self.note = ""
        self._asked = self._finder = MarkerFinder(settings, measure)
        self._count = settings.marker_count
        self._head = HeadOrder(settings.head, np.array(settings.distances) if settings.spacing else None)
        self._search_after_s = -np.inf
        self._trust = Trust()
        self._memory: MarkerMemory | None = None
        self._body: BodyWatch | None = None
        self._whole = True
        self._back: set[int] = set()

    @property
    def radius_px(self) -> float:
        """Radius of the markers as followed so far [px]; 0 before the start."""
        return 0.0 if self._memory is None else self._memory.radius_px

    def place(self, image: np.ndarray, points: np.ndarray, time_s: float) -> MarkerSet:
        """Start with the markers at `points` (m, 2) [px], head first, which a person has shown; there is no doubt.

        Raises TrackerError where there is no marker within the region about a point.
        """
        if len(points) != self._count:
            raise TrackerError(
                f"Found {len(points)} points for {self._count} markers; give one each, head first."
            )
        self._finder = self._asked.for_light_of(image)
        found = self._pointed_at(image, np.asarray(points, float), time_s)
        self._begin(found, time_s)
        links = links_at(image, places(found), range(self._count - 1), self.radius_px)
        # A person may point at dots that are not at the body's ends; these are found again, then, as they are.
        self._whole = not misfit(image, places(found), links, self.radius_px)
        self._body = BodyWatch(links, time_s, self._whole)
        self._head.learn()
        spacing = ",".join(f"{each:.1f}" for each in self._memory.chords_px)
        self.settings = replace(self.settings, spacing=spacing)
        self.note = "the markers are where they were pointed at"
        return self._as_set(found, np.ones(self._count, bool), Doubt.NONE, 0)

    def update(self, image: np.ndarray, time_s: float) -> MarkerSet:
        """Markers in an 8-bit BGR image taken at `time_s`; nothing is carried over from an earlier frame."""
        memory = self._memory
        if memory is not None and (time_s - memory.seen_at_s.max() > FORGET_AFTER_S or self._trust.broken):
            # What comes back after a while may lie the other way round: head and tail are told apart anew.
            memory = self._memory = None
        if memory is None:
            return self._start(image, time_s)
        missed_s = memory.time_s - memory.seen_at_s
        if missed_s.max() > LOOK_EVERYWHERE_AFTER_S and time_s >= self._search_after_s:
            markers = self._start(image, time_s)
            if markers.found.all():
                return markers
        return self._follow_all(image, time_s)

    # -- starting ---------------------------------------------------------------------------------------------------

    def _pointed_at(self, image: np.ndarray, points: np.ndarray, time_s: float) -> Measured:
        blobs = whole_frame_blobs(image, self._finder.settings)
        reach = self.settings.region_px
        placed = []
        for point in points:
            near = min(blobs, key=lambda blob: np.linalg.norm(blob.centre - point), default=None)
            if near is None or np.linalg.norm(near.centre - point) > reach + near.radius:
                raise TrackerError(
                    f"No dot of marker colour is at {point[0]:.0f},{point[1]:.0f} (within {reach} px) at "
                    f"{time_s:.3f} s; point at its middle, or learn its colour with `calibrate colour --at`."
                )
            placed.append(near)
        found = self._finder.of_blobs(image, placed)
        if not all(found):
            x, y = points[found.index(None)]
            raise TrackerError(f"The dot at {x:.0f},{y:.0f} has no clear edge; choose another frame.")
        for (x, y), each in zip(points, found, strict=True):
            off = float(np.hypot(*(each.centre - (x, y))))
            if off > max(MISSED_RADII * np.sqrt(each.area / np.pi), MISSED_PX):
                raise TrackerError(
                    f"What is seen at {x:.0f},{y:.0f} has its middle {off:.0f} px away, at "
                    f"{each.centre[0]:.0f},{each.centre[1]:.0f}: point at a dot's middle, in a frame in which nothing "
                    "lies over or beside it."
                )
        return found

    def _start(self, image: np.ndarray, time_s: float) -> MarkerSet:
        """Look everywhere. While some markers are being followed, only a whole row that is found changes anything."""
        if time_s < self._search_after_s:
            return MarkerSet.lost(self._count)
        following = self._memory is not None
        self._finder = self._asked.for_light_of(image)
        search = self._searched(image, time_s)
        row, doubt, note = search.row, search.doubt, search.note
        if row is not None and following:
            row, note = as_before(row, self._memory.last_seen), self.note
        elif row is not None:
            row, note = self._head.sort(row)
            doubt = Doubt.AMBIGUOUS if row is None else Doubt.NONE
        found = None if row is None else self._finder.of_blobs(image, row.blobs)
        if found is None or not all(found):
            if row is None:
                self._search_after_s = max(self._search_after_s, time_s + following * SEARCH_PERIOD_S)
            else:
                note = "the markers were found but their edges are not clear"
            self.note = self.note if following else note
            return MarkerSet.lost(self._count, doubt)
        self.note = note
        self._begin(found, time_s)
        self._body = BodyWatch(row.links, time_s, self._whole)
        return self._as_set(found, np.ones(self._count, bool), self._trust.shake(Doubt.STARTING), 0)

    def _searched(self, image: np.ndarray, time_s: float) -> StartSearch:
        search = search_start(image, self.settings, self._whole)
        if search.links > CHEAP_SEARCH_LINKS:
            self._search_after_s = time_s + SEARCH_PERIOD_S
        return search

    def _begin(self, found: Measured, time_s: float) -> None:
        self._memory = MarkerMemory(found, time_s, self.settings.region_px)
        self._trust = Trust()
        self._back = set()

    # -- following --------------------------------------------------------------------------------------------------

    def _follow_all(self, image: np.ndarray, time_s: float) -> MarkerSet:
        memory = self._memory
        predicted = memory.predicted(time_s)
        followed = [self._follow(image, number, predicted[number]) for number in range(self._count)]
        measured = [each for each, _ in followed]
        rivals = any(rival for each, rival in followed if each is not None)
        if self._body.seen:
            measured = without_strangers(image, measured, memory)
        if not all(measured):
            measured = self._found_again(image, measured, time_s)
        seen = accepted(measured, predicted, memory, self.settings.minimum_quality)
        positions = np.where(seen[:, None], places(measured), np.nan)
        self._back |= set(np.flatnonzero(seen & ~memory.seen))
        doubt, vouched = self._judged(image, positions, event(positions, predicted, memory, rivals), time_s)
        areas = np.array([np.nan if each is None else each.area for each in measured])
        memory.remember(positions, areas, predicted, time_s, sure=self._trust.pending is Doubt.NONE)
        return self._as_set(measured, seen, doubt, vouched)

    def _follow(self, image: np.ndarray, number: int, predicted: np.ndarray) -> tuple[Any, bool]:
        """The marker near its prediction, and whether something like it is about as near."""
        memory = self._memory
        wider = max(WIDER_REGION * self.settings.region_px, WIDER_REACH * memory.reach_px)
        for margin in (memory.reach_px, wider):
            measurement, outline = self._finder.near(image, predicted, memory.areas[number], margin)
            if measurement is not None:
                close = outline.distance_px > RIVAL_SHARE * outline.rival_px
                return measurement, close and outline.distance_px > 0.5 * memory.radius_px
        return None, False

    def _found_again(self, image: np.ndarray, measured: Measured, time_s: float) -> Measured:
        """Look for what is lost in the whole picture."""
        if any(measured):
            return found_beside(image, measured, self._memory, self._finder, self._body.seen)
        if time_s < self._search_after_s:
            return measured
        row = self._searched(image, time_s).row
        found = None if row is None else found_together(image, row, self._memory, self._finder)
        return measured if found is None else found

    def _judged(
        self, image: np.ndarray, positions: np.ndarray, happened: Doubt, time_s: float
    ) -> tuple[Doubt, int]:
        """The doubt about this frame, and how many frames before it this one vouches for."""
        if not np.isfinite(positions).all():
            self._trust.interrupt()
            return Doubt.NONE, 0
        if self._back and self._rival_near(image, positions):
            happened = Doubt.AMBIGUOUS
        if happened is Doubt.AMBIGUOUS:
            return self._trust.shake(happened, recoverable=False), 0
        unsure = self._trust.pending is not Doubt.NONE or happened is not Doubt.NONE
        if (unsure or self._body.due(time_s)) and not self._body.agrees(
            image, positions, self.radius_px, time_s
        ):
            return self._trust.disagree(), 0
        if happened is not Doubt.NONE:
            return self._trust.shake(self._trust.pending or happened), 0
        doubt, vouched = self._trust.agree()
        if doubt is Doubt.NONE:
            self._back = set()
            self._head.learn(self._memory.chords_px)
        return doubt, vouched

    def _rival_near(self, image: np.ndarray, positions: np.ndarray) -> bool:
        blobs = whole_frame_blobs(image, self._finder.settings)

        def link(first: Blob, last: Blob) -> BodyLink:
            return body_link(image, first.centre, last.centre, self.radius_px)

        return rival_near(blobs, positions, self._back, float(np.median(self._memory.areas)), link)

    def _as_set(self, measured: Measured, seen: np.ndarray, doubt: Doubt, vouched: int) -> MarkerSet:
        positions = np.where(seen[:, None], places(measured), np.nan)
        sigma = np.array([np.nan if each is None else each.sigma_px for each in measured])
        quality = np.where(seen, qualities(measured, self._memory), 0.0)
        return MarkerSet(positions, quality, np.where(seen, sigma, np.nan), doubt, vouched)
