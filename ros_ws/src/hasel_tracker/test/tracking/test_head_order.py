# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Rows in order, head first."""

import numpy as np
import pytest
from hasel_tracker.tracking.body_link import BodyLink
from hasel_tracker.tracking.head_order import HeadOrder, as_before, nearer_to, on_side, thicker_first
from hasel_tracker.tracking.marker_finder import Blob
from hasel_tracker.tracking.marker_row import MarkerRow
from hasel_tracker.tracking.tracker_settings import head_word

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


@pytest.mark.parametrize(
    ("side", "first"), [("left", True), ("right", False), ("top", False), ("bottom", True)]
)
def test_side_as_set(side, first):
    """A side that is set says which end it is."""
    row = np.array([[100.0, 300.0], [300.0, 200.0], [500.0, 100.0]])
    assert on_side(row, side) is first


def test_point_near_the_head():
    """A point that is set says which end is nearer to it."""
    row = np.array([[100.0, 300.0], [300.0, 200.0], [500.0, 100.0]])
    assert nearer_to(row, head_word("90,310"))
    assert not nearer_to(row, head_word("480, 150"))
    with pytest.raises(ValueError, match="could not convert"):
        head_word("upwards")


@pytest.mark.parametrize("widths", [(30.0, 28.0), (30.0, 21.0), (0.0, 30.0), (float("nan"), 30.0)])
def test_halves_that_look_alike_are_not_guessed(widths):
    """Where the two halves are about equally thick, or one cannot be measured, there is no answer."""
    assert thicker_first(tuple(BodyLink(9.0, width) for width in widths)) is None
