# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_tracker.tracking.marker_finder import Blob
from hasel_tracker.tracking.marker_memory import misplaced
from hasel_tracker.tracking.marker_search import assignments_of_lost

BODY = np.array([[400.0, 500.0], [950.0, 540.0], [1500.0, 450.0]])
CHORDS = np.linalg.norm(np.diff(BODY, axis=0), axis=1)
AREAS = np.full(3, 450.0)


def blob(x: float, y: float, area: float = 450.0, roundness: float = 0.95) -> Blob:
    """A candidate."""
    return Blob(np.array([x, y]), area, roundness)


def without(*numbers: int) -> np.ndarray:
    """The body with these markers lost."""
    known = BODY.copy()
    known[list(numbers)] = np.nan
    return known


def test_lost_tail_is_found_by_its_distance():
    """Of two candidates the one at the right distance from the middle marker is taken, even if the other is nearer."""
    near_but_wrong, right = blob(1300.0, 480.0), blob(1490.0, 420.0)
    found = assignments_of_lost([near_but_wrong, right], without(2), BODY, CHORDS, AREAS)
    assert len(found) == 1
    assert found[0][2] is right


def test_two_that_fit_are_both_told():
    """Two blobs at the right distance are two answers, the one nearer to where the marker was first."""
    near, far = blob(1490.0, 420.0), blob(1380.0, 880.0)
    assert [each[2] for each in assignments_of_lost([far, near], without(2), BODY, CHORDS, AREAS)] == [
        near,
        far,
    ]


def test_two_lost_markers_are_not_swapped():
    """Two blobs near where the markers were last seen are given to the nearer one each."""
    moved = np.add(BODY, [-40.0, 25.0])
    found = assignments_of_lost([blob(*moved[2]), blob(*moved[1])], without(1, 2), BODY, CHORDS, AREAS)
    assert [found[0][number].centre.tolist() for number in (1, 2)] == moved[1:].tolist()


def test_nothing_vouches_when_all_are_lost():
    """With no marker left to measure from, nothing is assigned by distances."""
    blobs = [blob(*point) for point in BODY]
    assert assignments_of_lost(blobs, without(0, 1, 2), BODY, CHORDS, AREAS) == []


@pytest.mark.parametrize(
    "stranger", [blob(1000.0, 900.0), blob(1490.0, 420.0, area=3000.0), blob(420.0, 620.0)]
)
def test_stranger_is_not_taken_for_a_lost_marker(stranger):
    """A blob at the wrong distance, of another size, or folded back onto the head, leaves the marker lost."""
    assert assignments_of_lost([stranger], without(2), BODY, CHORDS, AREAS) == []


@pytest.mark.parametrize("wrong", [0, 1, 2])
def test_marker_out_of_its_distances_is_named(wrong):
    """The one marker whose distances to its neighbours are off is found, also where only one of them tells."""
    moved = BODY.copy()
    moved[wrong] += [0.0, 700.0]
    residual = np.linalg.norm(moved - BODY, axis=1)
    assert misplaced(moved, residual, CHORDS).tolist() == [number == wrong for number in range(3)]
