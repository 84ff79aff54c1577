# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.video.annotation import BODY_COLOUR, HEAD_COLOUR, TAIL_COLOUR, annotate, preview

COLOURS = (HEAD_COLOUR, BODY_COLOUR, TAIL_COLOUR)


def ring_centre(picture: np.ndarray, colour: tuple[int, int, int]) -> np.ndarray:
    """Middle of the pixels of nearly this colour."""
    rows, columns = np.nonzero((np.abs(picture.astype(int) - colour) < 60).all(axis=2))
    return np.array([columns.min() + columns.max(), rows.min() + rows.max()]) / 2


def test_rings_lie_around_the_markers(frames):
    """Each marker gets a ring of its own colour around it; the original picture is left alone."""
    before = frames[40].image.copy()
    tracked = BendingTracker().update(frames[40].image, 0.3)
    picture = annotate(frames[40].image, tracked)
    for colour, position in zip(COLOURS, frames[40].markers_px, strict=True):
        assert np.abs(ring_centre(picture, colour) - position).max() < 1.5
    assert (frames[40].image == before).all()


def test_lost_marker_gets_no_ring(frames):
    """Where no marker was found nothing is drawn, and the text says so."""
    empty = np.full((360, 640, 3), 190, np.uint8)
    picture = annotate(empty, BendingTracker().update(empty, 0.0))
    assert not any((picture == colour).all(axis=2).any() for colour in COLOURS)
    assert (picture[:40] != empty[:40]).any()


def test_preview_is_small_with_rings_in_place(frames):
    """The preview has the width asked for, and the rings where the markers are in it."""
    tracked = BendingTracker().update(frames[40].image, 0.3)
    picture = preview(frames[40].image, tracked, 320)
    assert picture.shape == (180, 320, 3)
    assert np.abs(ring_centre(picture, COLOURS[2]) - 0.5 * frames[40].markers_px[2]).max() < 1.5
