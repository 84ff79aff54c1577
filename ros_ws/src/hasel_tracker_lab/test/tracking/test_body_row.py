# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A row of dots must be a body's markers: on its axis, out to its ends, beside no other body."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_tracker.tracking.body_link import body_link
from hasel_tracker.tracking.body_row import CROWDED, GOES_ON, OFF_AXIS, crowd, misfit
from hasel_tracker_lab.bench.accuracy import CONDITIONS, renderer_for
from hasel_tracker_lab.scenes.lab_scene import LabScene
from hasel_tracker_lab.scenes.lab_swimmer import LabSwimmer

RADIUS = 12.0
SWIMMER = LabSwimmer()


def judged(swimmers, dots):
    """What is said of dots at these places."""
    image = LabScene(swimmers, exposure_s=0.0).frame(0.2).image
    links = tuple(body_link(image, *pair, RADIUS) for pair in zip(dots[:-1], dots[1:], strict=True))
    return crowd(links, RADIUS), misfit(image, dots, links, RADIUS)


@pytest.mark.parametrize("electrodes", [False, True])
def test_the_markers_of_a_swimmer_are_a_row(electrodes):
    """Bent, tapered, with a thin fin, with electrodes beside the dots: nothing is said against the true markers."""
    swimmer = replace(SWIMMER, electrodes=electrodes)
    assert judged((swimmer,), swimmer.dots(0.2)) == ("", "")


@pytest.mark.parametrize("number", [0, 1, 2])
def test_a_dot_beside_the_axis_is_said(number):
    """A dot two and a half radii aside of where the body's axis runs is none of its markers."""
    bare = replace(SWIMMER, marked=False, fin_from=1.1)
    dots = bare.dots(0.2)
    along = np.diff(dots[[max(number - 1, 0), min(number + 1, 2)]], axis=0)[0]
    dots[number] += 2.5 * RADIUS * np.array([-along[1], along[0]]) / np.hypot(*along)
    assert judged((bare,), dots)[1] == OFF_AXIS


@pytest.mark.parametrize("stations", [(0.05, 0.4, 0.75), (0.3, 0.63, 0.97)])
def test_a_body_that_goes_on_beyond_the_dots_is_said(stations):
    """Where a fifth of the body lies beyond the outermost dot, a marker may be hidden there."""
    swimmer = replace(SWIMMER, stations=stations)
    assert judged((swimmer,), swimmer.dots(0.2)) == ("", GOES_ON)


def test_another_body_alongside_is_said():
    """A second body of the same shade along the first may be mistaken for a part of it."""
    beside = replace(SWIMMER, start_px=(320.0, 430.0), marked=False)
    assert judged((SWIMMER, beside), SWIMMER.dots(0.2))[0] == CROWDED


def test_a_spine_darker_than_the_ground_is_part_of_a_light_body():
    """The other renderer's swimmer at 1080p, a pale skin on a thin dark spine: its markers are a row."""
    for frame in renderer_for(CONDITIONS[2]).frames(12.0, 3):
        dots = frame.markers_px
        links = tuple(body_link(frame.image, *pair, RADIUS) for pair in zip(dots[:-1], dots[1:], strict=True))
        assert misfit(frame.image, dots, links, RADIUS) == ""
