"""Rows in order, head first."""

import numpy as np
import pytest
from hasel_tracker.tracking.blobs import Blob
from hasel_tracker.tracking.body_link import BodyLink
from hasel_tracker.tracking.head_order import HeadOrder, as_before
from hasel_tracker.tracking.marker_row import MarkerRow

CENTRES = np.array([[100.0, 300.0], [300.0, 310.0], [600.0, 300.0]])


def row(*widths: float) -> MarkerRow:
    """Markers from left to right on a body of these widths."""
    blobs = tuple(Blob(centre, 450.0, 0.95) for centre in CENTRES)
    return MarkerRow(blobs, tuple(BodyLink(9.0, width) for width in widths))


@pytest.mark.parametrize(
    ("head", "x"), [("left", 100.0), ("right", 600.0), ("580,320", 600.0), ("auto", 100.0)]
)
def test_what_is_said_goes_before_what_is_seen(head, x):
    """The head is where the user says, else before the thicker half; later rows go by the body alone."""
    order = HeadOrder(head)
    assert order.sort(row(60.0, 30.0))[0].centres[0, 0] == x
    order.learn()
    assert order.sort(row(60.0, 30.0))[0].centres[0, 0] == 100.0


def test_distances_tell_the_head_once_they_are_known():
    """Halves alike: no head at first; later the distances from marker to marker tell it, if they are unlike."""
    order = HeadOrder("auto")
    found, why = order.sort(row(30.0, 30.0))
    assert found is None
    assert "--head" in why
    order.learn(np.array([300.0, 200.0]))
    assert order.sort(row(30.0, 30.0))[0].centres[0, 0] == 600.0
    order.learn(np.array([250.0, 240.0]))
    assert order.sort(row(30.0, 30.0))[0] is None


def test_after_a_moment_the_order_is_the_nearer_one():
    """A row seen again shortly after lies as it lay."""
    moved = CENTRES + [20.0, -10.0]
    assert as_before(row(30.0, 30.0), moved).centres[0, 0] == 100.0
    assert as_before(row(30.0, 30.0), moved[::-1]).centres[0, 0] == 600.0
