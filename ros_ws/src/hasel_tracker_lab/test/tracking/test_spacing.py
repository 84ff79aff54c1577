# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The distances between the markers tell them from other dots: even ones unless something else was learnt or said."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_tracker.calibration.learned_settings import learn_colour
from hasel_tracker.errors import TrackerError
from hasel_tracker.tracking.bending_tracker import BendingTracker
from hasel_tracker.tracking.marker_row import spaced_as
from hasel_tracker.tracking.tracker_settings import TrackerSettings
from hasel_tracker_lab.scenes.lab_scene import LabScene
from hasel_tracker_lab.scenes.lab_swimmer import LabSwimmer

UNEVEN = LabSwimmer(stations=(0.05, 0.35, 0.97))


def angles(swimmer, **told):
    """Four frames: sin θ as tracked and as it is, and the tracker's note."""
    pictures = list(LabScene((swimmer,), exposure_s=0.0).frames(4))
    tracker = BendingTracker(**told)
    found = [tracker.update(each.image, each.time_s).sin_theta for each in pictures]
    return np.array(found), np.array([each.sin_theta for each in pictures]), tracker.note


def test_uneven_dots_have_no_angle_until_their_spacing_is_known():
    """Dots at uneven distances may be the rest of a longer row; after `calibrate colour --at` they are followed."""
    found, _, note = angles(UNEVEN)
    assert np.isnan(found).all()
    assert "calibrate colour" in note
    frame = next(LabScene((UNEVEN,), exposure_s=0.0).frames(1))
    learned = learn_colour(frame.image, frame.dots_px).settings
    assert [float(each) for each in learned.spacing.split(",")] == pytest.approx([192.0, 396.8], abs=1.0)
    found, true, _ = angles(UNEVEN, settings=learned)
    assert found[2:] == pytest.approx(true[2:], abs=2e-3)


def test_uneven_spacing_tells_the_head_where_both_halves_look_alike():
    """A body without taper has its head at the end that the spacing begins with, whichever way it lies."""
    alike = replace(UNEVEN, taper=1.0, fin_from=1.1, half_width_px=20.0)
    turned = replace(alike, start_px=(960.0, 360.0), heading_rad=np.pi)
    for swimmer in (alike, turned):
        found, true, _ = angles(swimmer, settings=TrackerSettings(spacing="30,62"))
        assert found[2:] == pytest.approx(true[2:], abs=2e-3)


def test_dots_away_from_the_ends_are_followed_when_pointed_at():
    """A person may point at dots that lie in the middle of the body."""
    inner = replace(UNEVEN, stations=(0.2, 0.5, 0.8))
    found, _, note = angles(inner)
    assert np.isnan(found).all()
    assert "the body goes on" in note
    start = next(LabScene((inner,), exposure_s=0.0).frames(1)).dots_px
    found, true, _ = angles(inner, start_at=start)
    assert found == pytest.approx(true, abs=2e-3)


@pytest.mark.parametrize(
    ("places", "distances", "same"),
    [
        ([0, 10, 20], (1, 1), True),
        ([0, 10, 24], (1, 1), False),
        ([0, 10, 30], (2, 1), True),
        ([0, 5], (7,), True),
    ],
)
def test_spacing_is_compared_in_both_directions_and_any_unit(places, distances, same):
    """Distances agree within a third of their ratio, either end first."""
    assert spaced_as(np.column_stack([places, np.zeros(len(places))]), distances) == same


@pytest.mark.parametrize("spacing", ["1", "1,2,3", "1,x", "1,-2"])
def test_spacing_that_cannot_be_is_explained(spacing):
    """One positive distance between each two markers."""
    with pytest.raises(TrackerError, match="expected 2 positive distances"):
        TrackerSettings(spacing=spacing)
