"""Follow the markers from frame to frame; find them at the start and when lost; say when that is in doubt."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.blobs import Outline, nearest_outline
from hasel_tracker.tracking.body_link import BodyLink, body_link
from hasel_tracker.tracking.doubt import Doubt
from hasel_tracker.tracking.head_side import head_word, nearer_to, on_side, thicker_first
from hasel_tracker.tracking.marker_contour import OUTSIDE_PX
from hasel_tracker.tracking.marker_measurement import MarkerMeasurement
from hasel_tracker.tracking.marker_order import assignments_of_lost, misplaced
from hasel_tracker.tracking.marker_row import MarkerRow, marker_candidates
from hasel_tracker.tracking.marker_set import MarkerSet
from hasel_tracker.tracking.marker_start import search_start, whole_frame_blobs
from hasel_tracker.tracking.tracker_settings import TrackerSettings
from hasel_tracker.tracking.trust import Trust

Measure = Callable[[np.ndarray, np.ndarray, int], MarkerMeasurement | None]

WIDER_REGION = 3
EXTRAPOLATED_FRAMES = 2
RIVAL_SHARE = 0.5
REACH_MEMORY = 0.98
FORGET_AFTER_S = 1.0
LOOK_EVERYWHERE_AFTER_S = 0.3
SEARCH_PERIOD_S = 0.1
CHEAP_SEARCH_LINKS = 8
LINK_PERIOD_S = 0.25
AREA_MEMORY = 0.02
CHORD_MEMORY = 0.02
CLEAR_CHORD_RATIO = 1.2
AREA_RATIO_AT_START = 2.0
RADIUS_TOLERANCE_PX = 0.7
LEAST_AREA_SHARE = 0.6


class MarkerTracker:
    """Follows `settings.marker_count` markers that `measure` locates within their outlines."""

    def __init__(self, settings: TrackerSettings, measure: Measure) -> None:
        self.settings = self._asked = settings
        self.note = ""
        self._measure_within = measure
        self._count = settings.marker_count
        self._head_layout: np.ndarray | None = None
        self._started_before = False
        self._search_after_s = -np.inf
        self._forget()

    def _forget(self) -> None:
        self._positions = np.full((self._count, 2), np.nan)
        self._velocities = np.zeros((self._count, 2))
        self._last_seen = np.full((self._count, 2), np.nan)
        self._seen_at_s = np.full(self._count, -np.inf)
        self._areas = np.zeros(self._count)
        self._chords: np.ndarray | None = None
        self._reach_px = float(self.settings.region_px)
        self._body_seen = True
        self._by_thickness = False
        self._linked_at_s = -np.inf
        self._time_s = np.nan
        self._trust = Trust()

    @property
    def radius_px(self) -> float:
        """Radius of the markers as followed so far [px]; 0 before the start."""
        return float(np.sqrt(np.median(self._areas) / np.pi))

    def place(self, image: np.ndarray, points: np.ndarray, time_s: float) -> MarkerSet:
        """Start with the markers at `points` (m, 2) [px], head first, which a person has shown; there is no doubt.

        Raises TrackerError where there is no marker within the region about a point.
        """
        if len(points) != self._count:
            raise TrackerError(
                f"Found {len(points)} points for {self._count} markers; give one each, head first."
            )
        self._adapt(image)
        blobs = whole_frame_blobs(image, self.settings)
        reach = self.settings.region_px
        placed = []
        for point in np.asarray(points, float):
            near = min(blobs, key=lambda blob: np.linalg.norm(blob.centre - point), default=None)
            if near is None or np.linalg.norm(near.centre - point) > reach + near.radius:
                raise TrackerError(
                    f"No dot of marker colour is at {point[0]:.0f},{point[1]:.0f} (within {reach} px) at "
                    f"{time_s:.3f} s; point at its middle, or learn its colour with `calibrate colour --at`."
                )
            placed.append(near)
        found = [self._measure(image, blob.centre, blob.area, reach)[0] for blob in placed]
        if not all(found):
            number = found.index(None)
            x, y = points[number]
            raise TrackerError(f"The dot at {x:.0f},{y:.0f} has no clear edge; choose another frame.")
        self._forget()
        self._begin(found, time_s)
        self._started_before = True
        self._body_seen = self._links_seen(image, range(self._count - 1))
        self.note = "the markers are where they were pointed at"
        return self._as_set(found, np.ones(self._count, bool), Doubt.NONE, 0)

    def update(self, image: np.ndarray, time_s: float) -> MarkerSet:
        """Markers in an 8-bit BGR image taken at `time_s`; nothing is carried over from an earlier frame."""
        if self._chords is None:
            return self._start(image, time_s)
        unseen_s = time_s - self._seen_at_s
        if unseen_s.min() > FORGET_AFTER_S or self._trust.broken:
            # What comes back after a while may lie the other way round: head and tail are told apart anew.
            self._forget()
            return self._start(image, time_s)
        missed_s = self._time_s - self._seen_at_s
        if missed_s.max() > LOOK_EVERYWHERE_AFTER_S and time_s >= self._search_after_s:
            markers = self._start(image, time_s)
            if markers.found.all():
                return markers
        return self._follow_all(image, time_s)

    # -- starting ---------------------------------------------------------------------------------------------------

    def _start(self, image: np.ndarray, time_s: float) -> MarkerSet:
        if time_s < self._search_after_s:
            return MarkerSet.lost(self._count)
        self._adapt(image)
        search = search_start(image, self._asked)
        if search.links > CHEAP_SEARCH_LINKS:
            self._search_after_s = time_s + SEARCH_PERIOD_S
        following = self._chords is not None
        row, doubt, note = (
            self._headed(search.row, following) if search.row else (None, search.doubt, search.note)
        )
        if row is None:
            self._search_after_s = max(self._search_after_s, time_s + following * SEARCH_PERIOD_S)
            self.note = self.note if following else note
            return MarkerSet.lost(self._count, doubt)
        found = [
            self._measure(image, blob.centre, blob.area, self.settings.region_px)[0] for blob in row.blobs
        ]
        if not all(found):
            self.note = self.note if following else "the markers were found but their edges are not clear"
            return MarkerSet.lost(self._count)
        self._forget()
        self.note = note
        self._by_thickness = thicker_first(row.links) is True
        self._begin(found, time_s)
        doubt = self._trust.shake(Doubt.STARTING)
        return self._as_set(found, np.ones(self._count, bool), doubt, 0)

    def _adapt(self, image: np.ndarray) -> None:
        """Take the marker's colour as it is in this picture's light."""
        self.settings = replace(self._asked, colour=self._asked.colour.for_light_of(image))

    def _headed(self, row: MarkerRow, following: bool) -> tuple[MarkerRow | None, Doubt, str]:
        """The row with its head first, if that can be told, and how."""
        first, how = self._head_first(row, following)
        if first is None:
            return None, Doubt.AMBIGUOUS, how
        return (row if first else row.reversed()), Doubt.NONE, how

    def _head_first(self, row: MarkerRow, following: bool) -> tuple[bool | None, str]:
        centres, head = row.centres, head_word(self.settings.head)
        if following and np.isfinite(self._last_seen).all():
            apart = [np.linalg.norm(each - self._last_seen) for each in (centres, centres[::-1])]
            return bool(apart[0] < apart[1]), self.note
        if not self._started_before and not isinstance(head, str):
            return nearer_to(centres, head), "the head is at the end nearest to the point given"
        if not self._started_before and head != "auto":
            return on_side(centres, head), f"the head is on the {head}, as set"
        thicker = thicker_first(row.links)
        if thicker is not None:
            return thicker, "the head is where the body is thicker"
        by_layout = self._first_by_layout(centres)
        if by_layout is not None:
            return by_layout, "the head is told by the markers' distances"
        return (
            None,
            "both halves of the body look alike: say where the head is with --head left, right or X,Y",
        )

    def _first_by_layout(self, centres: np.ndarray) -> bool | None:
        """Whether the distances between the markers are those known from before, if they tell the ends apart."""
        if self._head_layout is None or len(self._head_layout) < 2:
            return None
        layout = np.log(self._head_layout)
        if np.abs(layout - layout[::-1]).max() < np.log(CLEAR_CHORD_RATIO):
            return None
        chords = np.log(np.linalg.norm(np.diff(centres, axis=0), axis=1))
        apart = [np.linalg.norm(np.ptp(each - layout)) for each in (chords, chords[::-1])]
        return bool(apart[0] < apart[1])

    def _begin(self, found: list[MarkerMeasurement], time_s: float) -> None:
        self._positions = np.array([each.centre for each in found])
        self._last_seen = self._positions.copy()
        self._seen_at_s[:] = time_s
        self._areas = np.array([each.area for each in found])
        self._chords = np.linalg.norm(np.diff(self._positions, axis=0), axis=1)
        self._time_s = self._linked_at_s = time_s

    # -- following --------------------------------------------------------------------------------------------------

    def _follow_all(self, image: np.ndarray, time_s: float) -> MarkerSet:
        gap_s = time_s - self._time_s
        since_s = np.minimum(time_s - self._seen_at_s, EXTRAPOLATED_FRAMES * gap_s)
        predicted = self._last_seen + self._velocities * since_s[:, None]
        followed = [self._follow(image, number, predicted[number]) for number in range(self._count)]
        measured = [each[0] for each in followed]
        rivals = any(each is not None and each[1] for each in followed)
        present = np.isfinite(self._positions[:, 0])
        measured = self._without_strangers(image, measured, present)
        if not all(measured):
            measured = self._found_again(image, measured, time_s)
        accepted = self._accepted(measured, predicted)
        event = self._event(accepted, measured, predicted, present, rivals)
        doubt, vouched = self._judged(image, measured, accepted, event, time_s)
        self._remember(measured, accepted, predicted, time_s, gap_s)
        return self._as_set(measured, accepted, doubt, vouched)

    def _without_strangers(
        self, image: np.ndarray, measured: list[MarkerMeasurement | None], present: np.ndarray
    ) -> list[MarkerMeasurement | None]:
        """What seems to be a marker that was lost counts only if the body leads to it."""
        if not self._body_seen:
            return measured
        back = {n: each for n, each in enumerate(measured) if each is not None and not present[n]}
        places = np.array([np.full(2, np.nan) if each is None else each.centre for each in measured])
        known = [link for link in self._links_of(back) if np.isfinite(places[link : link + 2]).all()]
        for link in known:
            if not self._linked(image, places, [link]):
                for number in {link, link + 1} & set(back):
                    measured[number] = None
        return measured

    def _follow(
        self, image: np.ndarray, number: int, predicted: np.ndarray
    ) -> tuple[MarkerMeasurement | None, bool]:
        """The marker near its prediction, and whether something like it is about as near."""
        for margin in (self._reach_px, max(WIDER_REGION * self.settings.region_px, 1.5 * self._reach_px)):
            measurement, outline = self._measure(image, predicted, self._areas[number], int(margin))
            if measurement is not None:
                close = outline.distance_px > RIVAL_SHARE * outline.rival_px
                return measurement, close and outline.distance_px > 0.5 * self.radius_px
        return None, False

    def _measure(
        self, image: np.ndarray, predicted: np.ndarray, area: float, margin: int
    ) -> tuple[MarkerMeasurement | None, Outline | None]:
        radius = np.sqrt(area / np.pi)
        reach = int(radius + self.settings.edge_px + OUTSIDE_PX + 4 + margin)
        left, top = np.rint(predicted).astype(int) - reach
        right, bottom = left + 2 * reach + 1, top + 2 * reach + 1
        left, top = max(left, 0), max(top, 0)
        region = image[top : max(bottom, 0), left : max(right, 0)]
        if min(region.shape[:2]) < 2 * radius:
            return None, None
        mask = self.settings.colour.mask(region)
        outline = nearest_outline(mask, predicted - [left, top], area)
        if outline is None:
            return None, None
        measurement = self._measure_within(region, outline.contour, self.settings.edge_px)
        if measurement is None:
            return None, None
        return measurement.moved_by(np.array([left, top], float)), outline

    def _found_again(
        self, image: np.ndarray, measured: list[MarkerMeasurement | None], time_s: float
    ) -> list[MarkerMeasurement | None]:
        """Look for what is lost in the whole picture, next to what is not."""
        known = np.array([np.full(2, np.nan) if each is None else each.centre for each in measured])
        taken = known[~np.isnan(known[:, 0])]
        if not len(taken):
            return self._all_again(image, time_s) or measured
        radius = np.sqrt(self._areas.max() / np.pi)
        free = [
            blob
            for blob in marker_candidates(whole_frame_blobs(image, self.settings))
            if np.linalg.norm(taken - blob.centre, axis=1).min() > 2.0 * radius
        ]
        fitting = []
        for assignment in assignments_of_lost(free, known, self._last_seen, self._chords, self._areas):
            trial = known.copy()
            for number, blob in assignment.items():
                trial[number] = blob.centre
            if not self._body_seen or self._linked(image, trial, self._links_of(assignment)):
                fitting.append(assignment)
            if len(fitting) > 1:
                return measured  # several fit: none is taken
        if not fitting:
            return measured
        for number, blob in fitting[0].items():
            measured[number] = self._measure(image, blob.centre, blob.area, self.settings.region_px)[0]
        return measured

    def _all_again(self, image: np.ndarray, time_s: float) -> list[MarkerMeasurement] | None:
        """All were away for a moment: the one row in the picture, in the order that is nearest to the last."""
        if time_s < self._search_after_s:
            return None
        search = search_start(image, self._asked)
        if search.links > CHEAP_SEARCH_LINKS:
            self._search_after_s = time_s + SEARCH_PERIOD_S
        if search.row is None:
            return None
        row, _, _ = self._headed(search.row, following=True)
        thicker = thicker_first(row.links)
        if thicker is False:
            return None  # it lies the other way round: it is started anew when the old order is forgotten
        found = [
            self._measure(image, blob.centre, blob.area, self.settings.region_px)[0] for blob in row.blobs
        ]
        return found if all(found) else None

    def _links_of(self, numbers: dict[int, object]) -> set[int]:
        """The links that end at one of these markers."""
        return {link for number in numbers for link in (number - 1, number) if 0 <= link < self._count - 1}

    def _links_seen(self, image: np.ndarray, links: object) -> bool:
        return self._linked(image, self._positions, links)

    def _linked(self, image: np.ndarray, positions: np.ndarray, links: object) -> bool:
        return all(link.seen for link in self._links_at(image, positions, links))

    def _links_at(self, image: np.ndarray, positions: np.ndarray, links: object) -> tuple[BodyLink, ...]:
        return tuple(body_link(image, positions[each], positions[each + 1], self.radius_px) for each in links)

    # -- judging ----------------------------------------------------------------------------------------------------

    def _accepted(self, measured: list[MarkerMeasurement | None], predicted: np.ndarray) -> np.ndarray:
        """Which markers count as seen, shape (m,)."""
        accepted = np.array(
            [
                each is not None and self._quality(each, number) >= self.settings.minimum_quality
                for number, each in enumerate(measured)
            ]
        )
        positions = np.array(
            [each.centre if ok else np.full(2, np.nan) for each, ok in zip(measured, accepted, strict=True)]
        )
        residual = np.linalg.norm(positions - predicted, axis=1)
        return accepted & ~misplaced(positions, residual, self._chords)

    def _quality(self, measurement: MarkerMeasurement, number: int) -> float:
        """One for a full, clear marker; less for one that is cut, merged with something, or noisy."""
        wider_px = (np.sqrt(measurement.area) - np.sqrt(self._areas[number])) / np.sqrt(np.pi)
        tolerance = max(RADIUS_TOLERANCE_PX, 0.05 * self.radius_px)
        size = np.exp(-((wider_px / tolerance) ** 2))
        return float(np.clip(size * measurement.solidity * measurement.clarity, 0.0, 1.0))

    def _event(
        self,
        accepted: np.ndarray,
        measured: list[MarkerMeasurement | None],
        predicted: np.ndarray,
        present: np.ndarray,
        rivals: bool,
    ) -> Doubt:
        if rivals:
            return Doubt.AMBIGUOUS
        if (accepted & ~present).any():
            return Doubt.FOUND_AGAIN
        apart = [
            np.linalg.norm(each.centre - place)
            for each, place, ok in zip(measured, predicted, accepted, strict=True)
            if ok
        ]
        return Doubt.JUMP if max(apart, default=0.0) > self._reach_px else Doubt.NONE

    def _judged(
        self,
        image: np.ndarray,
        measured: list[MarkerMeasurement | None],
        accepted: np.ndarray,
        event: Doubt,
        time_s: float,
    ) -> tuple[Doubt, int]:
        """The doubt about this frame, and how many frames before it this one vouches for."""
        if not accepted.all():
            self._trust.interrupt()
            return Doubt.NONE, 0
        if event is Doubt.AMBIGUOUS:
            return self._trust.shake(event, recoverable=False), 0
        due = self._trust.pending is not Doubt.NONE or event is not Doubt.NONE
        due |= time_s - self._linked_at_s > LINK_PERIOD_S
        if due and self._body_seen:
            positions = np.array([each.centre for each in measured])
            links = self._links_at(image, positions, range(self._count - 1))
            turned = self._by_thickness and thicker_first(links) is False
            if turned or not all(link.seen for link in links):
                return self._trust.disagree(), 0
            self._linked_at_s = time_s
        if event is not Doubt.NONE:
            return self._trust.shake(self._trust.pending or event), 0
        doubt, vouched = self._trust.agree()
        if doubt is Doubt.NONE:
            self._started_before = True
            self._head_layout = self._chords
        return doubt, vouched

    def _remember(
        self,
        measured: list[MarkerMeasurement | None],
        accepted: np.ndarray,
        predicted: np.ndarray,
        time_s: float,
        gap_s: float,
    ) -> None:
        positions = np.array(
            [each.centre if ok else np.full(2, np.nan) for each, ok in zip(measured, accepted, strict=True)]
        )
        since_s = time_s - self._seen_at_s
        moved = (positions - self._last_seen) / np.where(since_s > 0.0, since_s, 1.0)[:, None]
        self._velocities = np.where(np.isfinite(moved) & (since_s > 0.0)[:, None], moved, self._velocities)
        residual = np.linalg.norm(positions - predicted, axis=1)[accepted].max(initial=0.0)
        usual = max(self.settings.region_px, 2.0 * residual, REACH_MEMORY * self._reach_px)
        self._reach_px = min(usual, 0.4 * float(self._chords.min()))
        self._reach_px = max(self._reach_px, float(self.settings.region_px))
        self._positions = positions
        self._last_seen[accepted] = positions[accepted]
        self._seen_at_s[accepted] = time_s
        self._time_s = time_s
        if accepted.all() and self._trust.pending is Doubt.NONE:
            areas = np.array([each.area for each in measured])
            self._areas = self._areas + AREA_MEMORY * (areas - self._areas)
            chords = np.linalg.norm(np.diff(positions, axis=0), axis=1)
            self._chords = self._chords + CHORD_MEMORY * (chords - self._chords)

    def _as_set(
        self, measured: list[MarkerMeasurement | None], accepted: np.ndarray, doubt: Doubt, vouched: int
    ) -> MarkerSet:
        positions, sigma = np.full((self._count, 2), np.nan), np.full(self._count, np.nan)
        quality = np.zeros(self._count)
        for number in np.flatnonzero(accepted):
            positions[number], sigma[number] = measured[number].centre, measured[number].sigma_px
            quality[number] = self._quality(measured[number], number)
        return MarkerSet(positions, quality, sigma, doubt, vouched)
