import numpy as np
import pytest
from hasel_tracker.tracking.blobs import Blob
from hasel_tracker.tracking.marker_order import assign_lost, body_line
from hypothesis import given
from hypothesis import strategies as st

BODY = np.array([[400.0, 500.0], [950.0, 540.0], [1500.0, 450.0]])
CHORDS = np.linalg.norm(np.diff(BODY, axis=0), axis=1)
AREAS = np.full(3, 450.0)


def blob(x: float, y: float, area: float = 450.0, roundness: float = 0.95) -> Blob:
    """A candidate."""
    return Blob(np.array([x, y]), area, roundness)


@given(turn=st.floats(-3.1, 3.1), order=st.permutations(range(5)))
def test_middle_marker_is_found_however_the_body_lies(turn, order):
    """Among five blobs, turned anyhow and in any order, the row of three like ones is found, its middle second."""
    cosine, sine = np.cos(turn), np.sin(turn)
    body = (BODY - BODY.mean(axis=0)) @ np.array([[cosine, -sine], [sine, cosine]]) + 900.0
    blobs = [blob(*point) for point in body] + [blob(100.0, 100.0, 4000.0, 0.2), blob(1700.0, 900.0, 60.0)]
    row = body_line([blobs[index] for index in order])
    assert [order[index] for index in row] in ([0, 1, 2], [2, 1, 0])


def test_no_row_among_things_that_are_not_markers():
    """Two blobs, or three that touch each other, are no body."""
    assert body_line([blob(100.0, 100.0), blob(500.0, 100.0)]) is None
    assert body_line([blob(100.0, 100.0), blob(120.0, 100.0), blob(140.0, 100.0)]) is None


def test_lost_tail_is_found_by_its_distance():
    """Of two candidates the one at the right distance from the middle marker is taken, even if the other is nearer."""
    known = BODY.copy()
    known[2] = np.nan
    near_but_wrong, right = blob(1300.0, 480.0), blob(1490.0, 420.0)
    found = assign_lost([near_but_wrong, right], known, BODY, CHORDS, AREAS)
    assert list(found) == [2]
    assert found[2] is right


def test_order_survives_when_all_are_lost():
    """Three blobs near where the markers were last seen are not swapped."""
    moved = np.add(BODY, [-40.0, 25.0])
    blobs = [blob(*moved[index]) for index in (2, 0, 1)]
    found = assign_lost(blobs, np.full((3, 2), np.nan), BODY, CHORDS, AREAS)
    assert [found[number].centre.tolist() for number in range(3)] == moved.tolist()


@pytest.mark.parametrize("stranger", [blob(1000.0, 900.0), blob(1490.0, 420.0, area=3000.0)])
def test_stranger_is_not_taken_for_a_lost_marker(stranger):
    """A blob at the wrong distance, or of another size, leaves the marker lost."""
    known = BODY.copy()
    known[2] = np.nan
    assert assign_lost([stranger], known, BODY, CHORDS, AREAS) == {}
