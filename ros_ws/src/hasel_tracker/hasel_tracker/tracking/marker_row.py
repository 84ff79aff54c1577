# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Which blobs are a row of markers along one body: alike, apart, not folded, and with the body between them."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from hasel_tracker.tracking.body_link import BodyLink
from hasel_tracker.tracking.marker_finder import Blob

MOST_CANDIDATES = 24
MOST_ROWS = 400
ROWS_LOOKED_AT = 60
LEAST_ROUNDNESS = 0.6
LARGEST_AREA_RATIO = 2.2
LARGEST_CHORD_RATIO = 4.0
LARGEST_TURN_RAD = 2.1
CLOSEST_RADII = 3.0
ON_THE_WAY_RADII = 1.5
RIVAL_SHARE_OF_CHORD = 0.4
LARGEST_UNEVENNESS = (
    4.0 / 3.0
)  # of the distances against those said: hands that glue, perspective, a bent body


@dataclass(frozen=True)
class MarkerRow:
    """Blobs in order along a body, either end first, and the links between them."""

    blobs: tuple[Blob, ...]
    links: tuple[BodyLink, ...]

    @property
    def centres(self) -> np.ndarray:
        """Positions, shape (m, 2) [px]."""
        return np.array([blob.centre for blob in self.blobs])

    def reversed(self) -> "MarkerRow":
        """The same row with its other end first."""
        return MarkerRow(self.blobs[::-1], self.links[::-1])


def marker_candidates(blobs: list[Blob]) -> list[Blob]:
    """Whole, round blobs; those that are both large and round first, so that specks displace no marker."""
    whole = [blob for blob in blobs if not blob.cut and blob.roundness > LEAST_ROUNDNESS]
    return sorted(whole, key=lambda blob: -(blob.roundness**2) * blob.radius)[:MOST_CANDIDATES]


def possible_rows(blobs: list[Blob], count: int) -> list[tuple[int, ...]]:
    """Rows of `count` of the blobs by their layout alone, the most regular first, each in one direction only.

    Of rows that grow marker by marker the MOST_ROWS most regular are kept, so that fifteen take no longer than three.
    """
    centres = np.array([blob.centre for blob in blobs]).reshape(-1, 2)
    areas = np.log([blob.area for blob in blobs])
    radii = np.array([blob.radius for blob in blobs])
    apart = np.linalg.norm(centres[:, None] - centres[None, :], axis=2)
    between = _between(centres, areas, radii, apart)
    rows = [(0.0, (index,)) for index in range(len(blobs))]
    for _ in range(count - 1):
        longer = []
        for cost, row in rows:
            for index in range(len(blobs)):
                if index in row:
                    continue
                more = _step_cost(row, index, centres, areas, radii, apart)
                if np.isfinite(more) and not between[row[-1], index]:
                    longer.append((cost + more, (*row, index)))
        rows = sorted(longer)[: MOST_ROWS * 2]
    return [row for _, row in rows if row[0] < row[-1]]


def _between(centres: np.ndarray, areas: np.ndarray, radii: np.ndarray, apart: np.ndarray) -> np.ndarray:
    """Whether a like blob lies on the way from one to another (n, n): such two are no neighbours along a body."""
    along = centres[None, :] - centres[:, None]
    length = np.maximum(apart, 1e-9)
    there = centres[None, None, :] - centres[:, None, None]  # (from, to, blob, 2)
    share = (there * along[:, :, None]).sum(axis=3) / length[..., None] ** 2
    aside = (
        np.abs(there[..., 0] * along[:, :, None, 1] - there[..., 1] * along[:, :, None, 0])
        / length[..., None]
    )
    like = np.abs(areas[None, :] - areas[:, None]) < np.log(LARGEST_AREA_RATIO)  # (from, blob)
    clear = CLOSEST_RADII * radii / length[..., None]
    on_way = (share > clear) & (share < 1.0 - clear) & (aside < ON_THE_WAY_RADII * radii)
    return (on_way & like[:, None, :]).any(axis=2)


def _step_cost(
    row: tuple[int, ...],
    index: int,
    centres: np.ndarray,
    areas: np.ndarray,
    radii: np.ndarray,
    apart: np.ndarray,
) -> float:
    last = row[-1]
    length = apart[last, index]
    unlike = areas[index] - np.median(areas[list(row)])
    if length < CLOSEST_RADII * max(radii[last], radii[index]) or abs(unlike) > np.log(LARGEST_AREA_RATIO):
        return np.inf
    cost = (unlike / 0.3) ** 2
    if len(row) == 1:
        return float(cost)
    before = row[-2]
    uneven = np.log(length / apart[before, last])
    front, rear = centres[last] - centres[before], centres[index] - centres[last]
    turn = np.arccos(np.clip(front @ rear / (length * apart[before, last]), -1.0, 1.0))
    if abs(uneven) > np.log(LARGEST_CHORD_RATIO) or turn > LARGEST_TURN_RAD:
        return np.inf
    return float(cost + (uneven / 0.4) ** 2 + (turn / 0.8) ** 2)


def rival_near(
    blobs: list[Blob],
    positions: np.ndarray,
    numbers: Iterable[int],
    area: float,
    link: Callable[[Blob, Blob], BodyLink],
) -> bool:
    """Whether the body leads to a blob so near one of these markers that it, or what it hides, may be the marker.

    positions: (m, 2) [px] of all markers, of about `area` [px²]. Such a blob may be two things that touch: it need be
    neither round nor of the right size, unless it is small.
    """
    radius = np.sqrt(area / np.pi)
    near_px = RIVAL_SHARE_OF_CHORD * np.linalg.norm(np.diff(positions, axis=0), axis=1).min()
    others = [
        blob
        for blob in blobs
        if blob.area * LARGEST_AREA_RATIO > area
        and np.linalg.norm(positions - blob.centre, axis=1).min() > radius
    ]
    for number in numbers:
        neighbours = [
            Blob(positions[n], area, 1.0) for n in (number - 1, number + 1) if 0 <= n < len(positions)
        ]
        for blob in others:
            near = np.linalg.norm(positions[number] - blob.centre) < near_px
            if near and all(link(each, blob).seen for each in neighbours):
                return True
    return False


def spaced_as(centres: np.ndarray, distances: Sequence[float]) -> bool:
    """Whether points (m, 2), either end first, are as far from each other as `distances` (m - 1) say, in any unit."""
    chords = np.linalg.norm(np.diff(centres, axis=0), axis=1)
    ratios = [chords / np.asarray(each) for each in (distances, distances[::-1])]
    return bool(min(ratio.max() / ratio.min() for ratio in ratios) <= LARGEST_UNEVENNESS)


def rows_on_a_body(
    blobs: list[Blob],
    count: int,
    link: Callable[[Blob, Blob], BodyLink],
    most: int = 2,
    distances: Sequence[float] | None = None,
) -> list[MarkerRow]:
    """Up to `most` rows between whose markers a body is seen; two mean that the picture does not say which it is.

    distances: from marker to marker, in any unit; None for any.
    """
    known: dict[tuple[int, int], BodyLink] = {}
    found: list[MarkerRow] = []
    centres = np.array([blob.centre for blob in blobs]).reshape(-1, 2)
    rows = [
        row
        for row in possible_rows(blobs, count)
        if distances is None or spaced_as(centres[list(row)], distances)
    ]
    for row in rows[:ROWS_LOOKED_AT]:
        links = []
        for pair in zip(row[:-1], row[1:], strict=True):
            key = (min(pair), max(pair))
            if key not in known:
                known[key] = link(blobs[key[0]], blobs[key[1]])
            if not known[key].seen:
                break
            links.append(known[key])
        else:
            found.append(MarkerRow(tuple(blobs[index] for index in row), tuple(links)))
            if len(found) == most:
                break
    return found
