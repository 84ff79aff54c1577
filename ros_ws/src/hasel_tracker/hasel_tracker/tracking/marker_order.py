"""Which three blobs are the markers, and which of them is the head, the middle and the tail."""

from itertools import combinations, permutations

import numpy as np

from hasel_tracker.tracking.blobs import Blob

MOST_CANDIDATES = 8
LARGEST_START_COST = 60.0
CHORD_TOLERANCE = 0.2


def body_line(blobs: list[Blob]) -> np.ndarray | None:
    """Indices (3,) of the three blobs most like markers in a row, the middle one second; None if none are.

    Markers are alike in size, round, about equally far apart and not folded onto each other.
    """
    candidates = _most_marker_like(blobs)
    best, lowest = None, LARGEST_START_COST
    for triple in combinations(candidates, 3):
        for middle in range(3):
            order = [triple[middle - 1], triple[middle], triple[(middle + 1) % 3]]
            cost = _row_cost([blobs[index] for index in order])
            if cost < lowest:
                best, lowest = np.array(order), cost
    return best


def _most_marker_like(blobs: list[Blob]) -> list[int]:
    by_roundness = sorted(range(len(blobs)), key=lambda index: -blobs[index].roundness)
    return by_roundness[:MOST_CANDIDATES]


def _row_cost(row: list[Blob]) -> float:
    areas = np.log([blob.area for blob in row])
    front, rear = row[1].centre - row[0].centre, row[2].centre - row[1].centre
    lengths = np.hypot(*front), np.hypot(*rear)
    if min(lengths) < 4.0 * max(blob.radius for blob in row):
        return np.inf
    turn = np.arccos(np.clip(front @ rear / (lengths[0] * lengths[1]), -1.0, 1.0))
    uneven = np.log(lengths[0] / lengths[1]) / 0.3
    unlike = (areas - np.median(areas)) / 0.4
    unround = (1.0 - np.array([blob.roundness for blob in row])) / 0.3
    return float(unlike @ unlike + unround @ unround + uneven**2 + (turn / 0.8) ** 2)


def assign_lost(
    blobs: list[Blob], known: np.ndarray, expected: np.ndarray, chords: np.ndarray, areas: np.ndarray
) -> dict[int, Blob]:
    """Blobs for the lost markers so that the distances along the body stay what they were.

    known: (3, 2) with NaN for lost markers [px]; expected: (3, 2) where each was last seen; chords: (2,)
    distances head–middle and middle–tail [px]; areas: (3,) [px²]. Returns marker number → blob; empty if
    nothing fits.
    """
    lost = np.flatnonzero(np.isnan(known[:, 0]))
    near = 0.1 * chords.sum()
    best, lowest = {}, np.inf
    for choice in permutations(range(min(len(blobs), MOST_CANDIDATES)), len(lost)):
        trial = known.copy()
        trial[lost] = [blobs[index].centre for index in choice]
        stretch = np.linalg.norm(np.diff(trial, axis=0), axis=1) / chords - 1.0
        if np.abs(stretch).max() > CHORD_TOLERANCE:
            continue
        unlike = np.log([blobs[i].area / areas[j] for i, j in zip(choice, lost, strict=True)])
        if np.abs(unlike).max() > 1.0:
            continue
        jump = (trial[lost] - expected[lost]) / near
        cost = (stretch @ stretch) / 0.05**2 + (unlike @ unlike) / 0.3**2 + (jump**2).sum()
        if cost < lowest:
            best = {int(j): blobs[i] for i, j in zip(choice, lost, strict=True)}
            lowest = cost
    return best
