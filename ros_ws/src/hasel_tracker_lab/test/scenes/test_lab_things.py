"""Things that get into the picture."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_tracker_lab.scenes.lab_camera import LabCamera
from hasel_tracker_lab.scenes.lab_scene import LabScene
from hasel_tracker_lab.scenes.lab_swimmer import LabSwimmer
from hasel_tracker_lab.scenes.lab_things import SKIN, Bubble, Cable, Glare, Hand

CLEAN = LabCamera(blur_px=0.0, noise_levels=0.0, bayer=False, half_colour=False)
SCENE = LabScene((LabSwimmer(rest_s=9.0),), camera=CLEAN, exposure_s=0.0, light_fall=0.0)
HEAD = (352.0, 360.0)


@pytest.mark.parametrize(
    "thing",
    [
        Hand((HEAD[0] - 30.0, HEAD[1]), colour=SKIN, velocity=(-400.0, 0.0)),
        Cable((HEAD[0], 0.0), (HEAD[0], 720.0), width=30.0, colour=SKIN, velocity=(-400.0, 0.0)),
        Bubble(HEAD, 20.0, colour=SKIN, velocity=(-400.0, 0.0)),
    ],
    ids=lambda thing: type(thing).__name__,
)
def test_what_lies_over_a_dot_hides_it_until_it_moves_on(thing):
    """The truth says which dots are out of sight, and the picture agrees."""
    scene = replace(SCENE, things=(thing,))
    hidden, free = scene.frame(0.0), scene.frame(0.5)
    assert hidden.seen.tolist() == [False, True, True]
    assert free.seen.all()
    x, y = int(HEAD[0]), int(HEAD[1])
    assert hidden.image[y, x] == pytest.approx(SKIN, abs=1.5)
    assert free.image[y, x] == pytest.approx((150.0, 60.0, 25.0), abs=1.5)


def test_glare_lightens_and_hides_nothing_wholly():
    """A lamp's reflection takes the picture towards white where it is; every dot stays in view for the truth."""
    plain, lit = SCENE.frame(0.0), replace(SCENE, things=(Glare(HEAD, 40.0, 0.5),)).frame(0.0)
    assert lit.seen.all()
    x, y = int(HEAD[0]), int(HEAD[1])
    assert lit.image[y, x] == pytest.approx(0.5 * (plain.image[y, x] + 255.0), abs=1.5)
    assert np.abs(lit.image[700, 1200].astype(int) - plain.image[700, 1200]).max() <= 1
