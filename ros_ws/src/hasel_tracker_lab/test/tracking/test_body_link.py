# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Whether a body runs between two dots."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_tracker.tracking.body_link import LEAST_EVIDENCE, body_link
from hasel_tracker_lab.scenes.lab_scene import BlueDot, LabScene
from hasel_tracker_lab.scenes.lab_swimmer import LabSwimmer

SCENES = {
    "plain": LabScene(exposure_s=0.0),
    "electrodes": LabScene((LabSwimmer(electrodes=True),), exposure_s=0.0),
    "textured": LabScene(texture=22.0, exposure_s=0.0),
    "dark tank": LabScene(water=(38.0, 36.0, 32.0), exposure_s=0.0),
}


@pytest.mark.parametrize("scene", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("time_s", [0.0, 0.12, 0.3])
def test_body_is_seen_and_its_width_is_about_right(scene, time_s):
    """On any ground, bent either way, both links of a swimmer are seen; the widths are those that were painted."""
    frame = scene.frame(time_s)
    links = [body_link(frame.image, *frame.dots_px[n : n + 2], 12.0) for n in (0, 1)]
    assert min(link.evidence for link in links) > LEAST_EVIDENCE
    assert links[0].width_px == pytest.approx(55.0, rel=0.4)
    assert not links[1].width_px > 1.4 * links[0].width_px


@pytest.mark.parametrize("texture", [0.0, 10.0, 25.0, 40.0])
@pytest.mark.parametrize("grain_px", [3.0, 15.0])
def test_no_body_between_places_in_the_water(texture, grain_px):
    """Between 20 pairs of places on a plain or textured ground without a swimmer no body is seen."""
    random = np.random.default_rng(3)
    image = LabScene((), texture=texture, grain_px=grain_px, exposure_s=0.0).frame(0.0).image
    for _ in range(20):
        first, last = random.uniform([120, 120], [1160, 600], (2, 2))
        assert not body_link(image, first, last, 12.0).seen


def test_dot_beside_the_tail_is_not_on_the_body():
    """A dot at the tail's distance from the middle, half a radian to the side, has no body before it."""
    swimmer = LabSwimmer(bend_rad=0.6)
    _, middle, tail = swimmer.dots(0.1)
    for angle in (-0.5, 0.5):
        turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
        place = middle + turn @ (tail - middle)
        scene = replace(LabScene((swimmer,)), dots=(BlueDot(*place),), exposure_s=0.0)
        assert not body_link(scene.frame(0.1).image, middle, place, 12.0).seen
