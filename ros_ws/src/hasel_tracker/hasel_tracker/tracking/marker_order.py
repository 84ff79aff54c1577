"""Which blobs are the markers that were lost, so that markers do not swap and strangers are not taken for them."""

from itertools import permutations

import numpy as np

from hasel_tracker.tracking.blobs import Blob

MOST_CANDIDATES = 8
MOST_LOST = 2
CHORD_TOLERANCE = (
    0.1  # a body that keeps its length and turns by 100° shortens its chords by 3 %; the rest is perspective
)
LARGEST_AREA_RATIO = 2.0
LARGEST_TURN_RAD = 2.1


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


def misplaced(positions: np.ndarray, residual_px: np.ndarray, chords: np.ndarray) -> np.ndarray:
    """Which markers (m,) are nowhere near their distance from their neighbours.

    positions: (m, 2) [px]; residual_px: (m,) how far each is from where it was predicted; chords: (m - 1,) [px].
    """
    wrong = np.abs(np.linalg.norm(np.diff(positions, axis=0), axis=1) / chords - 1.0) > CHORD_TOLERANCE
    blame = np.zeros(len(positions), bool)
    for number in np.flatnonzero(wrong):
        first, last = number, number + 1
        if blame[first] or blame[last]:
            continue
        votes = [_wrong_chords(wrong, each) for each in (first, last)]
        if votes[0] != votes[1]:
            blame[first if votes[0] > votes[1] else last] = True
        else:
            blame[
                first if np.nan_to_num(residual_px[first]) >= np.nan_to_num(residual_px[last]) else last
            ] = True
    return blame


def _wrong_chords(wrong: np.ndarray, marker: int | np.integer) -> float:
    """Share of a marker's chords that are wrong."""
    return float(wrong[max(marker - 1, 0) : marker + 1].mean())
