# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Rows of markers among blobs."""

import numpy as np
import pytest
from hasel_tracker.tracking.body_link import BodyLink
from hasel_tracker.tracking.marker_finder import Blob
from hasel_tracker.tracking.marker_row import marker_candidates, possible_rows, rival_near, rows_on_a_body
from hypothesis import given
from hypothesis import strategies as st

BODY = np.array([[400.0, 500.0], [950.0, 540.0], [1500.0, 450.0]])
SEEN, UNSEEN = BodyLink(9.0, 30.0), BodyLink(0.5, 0.0)


def blob(x: float, y: float, area: float = 450.0, roundness: float = 0.95, cut: bool = False) -> Blob:
    """A candidate."""
    return Blob(np.array([x, y]), area, roundness, cut)


def names(row: tuple[int, ...], order: list[int]) -> list[int]:
    """The blobs' numbers before they were shuffled."""
    return [order[index] for index in row]


@given(turn=st.floats(-3.1, 3.1), order=st.permutations(range(5)))
def test_middle_marker_is_found_however_the_body_lies(turn, order):
    """Among five blobs, turned anyhow and in any order, the row of three like ones comes first, its middle second."""
    cosine, sine = np.cos(turn), np.sin(turn)
    body = (BODY - BODY.mean(axis=0)) @ np.array([[cosine, -sine], [sine, cosine]]) + 900.0
    blobs = [blob(*point) for point in body] + [blob(100.0, 100.0, 4000.0, 0.2), blob(1700.0, 900.0, 60.0)]
    best = possible_rows([blobs[index] for index in order], 3)[0]
    assert names(best, order) in ([0, 1, 2], [2, 1, 0])


@pytest.mark.parametrize("count", [2, 3, 5, 8, 15])
def test_any_number_of_markers(count):
    """Two to fifteen dots on a curved body are put in order whatever order they are seen in."""
    turn = np.cumsum(np.full(count, 1.6 / count))
    body = 300.0 + np.cumsum(np.column_stack([np.cos(turn), np.sin(turn)]) * 90.0, axis=0)
    order = list(np.random.default_rng(count).permutation(count))
    best = possible_rows([blob(*body[index]) for index in order], count)[0]
    assert names(best, order) in (list(range(count)), list(range(count))[::-1])


def test_no_row_among_things_that_are_not_markers():
    """Two blobs, three that touch each other, or three of very unlike size, are no row."""
    assert possible_rows([blob(100.0, 100.0), blob(500.0, 100.0)], 3) == []
    assert possible_rows([blob(100.0, 100.0), blob(120.0, 100.0), blob(140.0, 100.0)], 3) == []
    assert possible_rows([blob(100.0, 100.0), blob(500.0, 100.0, 4500.0), blob(900.0, 100.0)], 3) == []


def test_cut_blobs_and_specks_come_last():
    """A blob at the picture's edge is no candidate, and many specks do not displace the dots."""
    specks = [blob(10.0 * n, 700.0, 20.0, 1.0) for n in range(40)]
    dots = [blob(*point, roundness=0.85) for point in BODY]
    found = marker_candidates([*specks, *dots, blob(1.0, 300.0, cut=True)])
    assert {id(each) for each in found[:3]} == {id(each) for each in dots}
    assert not any(each.cut for each in found)


def test_only_rows_with_a_body_between_the_dots_count():
    """Without a body there is no row; with two bodies there are two, which the caller must not choose between."""
    other = BODY + [0.0, 250.0]
    blobs = [blob(*point) for point in np.vstack([BODY, other])]
    assert rows_on_a_body(blobs, 3, lambda a, b: UNSEEN) == []
    same = lambda a, b: SEEN if abs(a.centre[1] - b.centre[1]) < 120.0 else UNSEEN  # noqa: E731
    assert len(rows_on_a_body(blobs, 3, same)) == 2
    assert len(rows_on_a_body(blobs[:3], 3, same)) == 1


def test_neighbours_have_no_other_dot_between_them():
    """Of four like dots in a line no row of three skips one; a speck between two dots does not part them."""
    line = [blob(200.0 + 150.0 * number, 300.0) for number in range(4)]
    assert {tuple(sorted(row)) for row in possible_rows(line, 3)} == {(0, 1, 2), (1, 2, 3)}
    speck = blob(425.0, 302.0, area=60.0)
    assert (0, 1, 2) in possible_rows([*line[:3], speck], 3)


@pytest.mark.parametrize(
    ("other", "link", "rival"),
    [
        (blob(1460.0, 500.0), SEEN, True),
        (blob(1460.0, 500.0, area=1500.0, roundness=0.3), SEEN, True),  # two things that touch
        (blob(1460.0, 500.0), UNSEEN, False),
        (blob(1460.0, 500.0, area=60.0), SEEN, False),
        (blob(1500.0, 100.0), SEEN, False),
    ],
)
def test_a_rival_lies_near_a_marker_and_on_the_body(other, link, rival):
    """Something of a marker's size or more beside a marker, to which the body leads, may be the marker instead."""
    blobs = [*(blob(*point) for point in BODY), other]
    assert rival_near(blobs, BODY, range(3), 450.0, lambda a, b: link) is rival
    assert not rival_near(blobs[:3], BODY, range(3), 450.0, lambda a, b: link)
