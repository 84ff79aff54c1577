"""Which blobs are a row of markers along one body: alike, apart, not folded, and with the body between them."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hasel_tracker.tracking.blobs import Blob
from hasel_tracker.tracking.body_link import BodyLink

MOST_CANDIDATES = 24
MOST_ROWS = 400
ROWS_LOOKED_AT = 60
LEAST_ROUNDNESS = 0.6
LARGEST_AREA_RATIO = 2.2
LARGEST_CHORD_RATIO = 4.0
LARGEST_TURN_RAD = 2.1
CLOSEST_RADII = 3.0


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
    rows = [(0.0, (index,)) for index in range(len(blobs))]
    for _ in range(count - 1):
        longer = []
        for cost, row in rows:
            for index in range(len(blobs)):
                if index in row:
                    continue
                more = _step_cost(row, index, centres, areas, radii, apart)
                if np.isfinite(more):
                    longer.append((cost + more, (*row, index)))
        rows = sorted(longer)[: MOST_ROWS * 2]
    return [row for _, row in rows if row[0] < row[-1]]


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


def rows_on_a_body(
    blobs: list[Blob], count: int, link: Callable[[Blob, Blob], BodyLink], most: int = 2
) -> list[MarkerRow]:
    """Up to `most` rows between whose markers a body is seen; two mean that the picture does not say which it is."""
    known: dict[tuple[int, int], BodyLink] = {}
    found: list[MarkerRow] = []
    for row in possible_rows(blobs, count)[:ROWS_LOOKED_AT]:
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
