# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_tracker.calibration.learned_settings import SELECTED, learn_colour, learned_picture
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.marker_contour import measure_contour
from hasel_tracker.tracking.marker_tracker import MarkerTracker


def test_blue_markers_are_learned_without_help(frames):
    """From one frame: the colour, the radius, and the markers where they are; nothing else has that colour."""
    learned = learn_colour(frames[30].image)
    assert np.abs(learned.markers_px - frames[30].markers_px).max() < 0.1
    assert learned.settings.marker_radius_px == pytest.approx(5.6, abs=0.6)
    assert learned.stray_share < 1e-4
    assert "hue" in str(learned)


@pytest.mark.parametrize("channels", [[1, 0, 2], [2, 1, 0], [2, 0, 1]])
def test_markers_of_any_colour_are_learned_by_pointing(frames, channels):
    """Green, red and purple markers are learned from a pixel on each, and then followed by themselves."""
    picture = np.ascontiguousarray(frames[30].image[..., channels])
    learned = learn_colour(picture, frames[30].markers_px[::-1] + 1.0)
    markers = MarkerTracker(learned.settings, measure_contour).update(picture, 0.0)
    assert np.abs(markers.positions - frames[30].markers_px).max() < 0.3


def test_picture_shows_what_is_selected(frames):
    """Pixels of the learned colour are painted, all others are grey or annotation."""
    learned = learn_colour(frames[30].image)
    picture = learned_picture(frames[30].image, learned)
    painted = (picture == SELECTED).all(axis=2)
    assert painted.sum() == pytest.approx(3 * np.pi * learned.settings.marker_radius_px**2, rel=0.35)


def test_failures_are_explained(frames):
    """A picture without markers, or points beside them, is explained in one sentence."""
    with pytest.raises(TrackerError, match="point at the markers with --at"):
        learn_colour(np.full((360, 640, 3), 150, np.uint8))
    with pytest.raises(TrackerError, match="outside the image"):
        learn_colour(frames[0].image, np.array([[10.0, 10.0], [2000.0, 10.0], [30.0, 30.0]]))
