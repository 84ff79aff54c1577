# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
from dataclasses import replace

import numpy as np
import pytest
from hasel_tracker_lab.scenes.lab_scene import BlueDot, LabCamera, LabScene
from hasel_tracker_lab.scenes.lab_swimmer import LabSwimmer
from hasel_tracker_lab.scenes.lab_things import SKIN, Bubble, Cable, Glare, Hand
from hasel_tracker_lab.scenes.painting import Canvas

CLEAN = LabCamera(blur_px=0.0, noise_levels=0.0, bayer=False, half_colour=False)
SCENE = LabScene((LabSwimmer(rest_s=9.0),), camera=CLEAN, exposure_s=0.0, light_fall=0.0)
HEAD = (352.0, 360.0)


def test_disc_has_its_area_and_its_centre():
    """A painted disc of any radius and place has the area π r² and the centroid asked for, to thousandths."""
    for radius, centre in ((3.3, [20.2, 17.7]), (12.0, [30.5, 31.0])):
        canvas = Canvas(np.zeros((64, 64, 3)))
        canvas.disc(np.array(centre), radius, (1.0, 1.0, 1.0))
        weight = canvas.picture[..., 0]
        rows, columns = np.indices(weight.shape)
        assert weight.sum() == pytest.approx(np.pi * radius**2, rel=6e-3)
        found = [(weight * columns).sum() / weight.sum(), (weight * rows).sum() / weight.sum()]
        assert found == pytest.approx(centre, abs=8e-3)


def test_body_keeps_its_length_and_rests_straight():
    """The centre line is as long bent as straight; before the drive starts the body is straight."""
    swimmer = LabSwimmer(rest_s=0.1)
    for time_s in (0.0, 0.2, 0.33):
        steps = np.diff(swimmer.centre_line(time_s), axis=0)
        assert np.hypot(*steps.T).sum() == pytest.approx(640.0)
    assert np.ptp(swimmer.centre_line(0.05)[:, 1]) == pytest.approx(0.0, abs=1e-9)


def test_dots_lie_where_the_truth_says():
    """The darkest blue of a clean picture lies at the dots, and a covered dot is not there."""
    swimmer = LabSwimmer(hidden=((1, 0.0, 1.0),))
    frame = LabScene((swimmer,), camera=CLEAN, exposure_s=0.0, light_fall=0.0, shadow=0.0).frame(0.1)
    assert frame.seen.tolist() == [True, False, True]
    for (x, y), seen in zip(np.rint(frame.dots_px).astype(int), frame.seen, strict=True):
        blue, _, red = (int(value) for value in frame.image[y, x])
        assert (blue - red > 90) == seen


def test_same_seed_same_picture():
    """Noise depends on the seed alone."""
    scene = LabScene((), (BlueDot(50.0, 50.0),), size_px=(160, 120))
    first, again, other = (
        next(iter(each.frames(1))).image for each in (scene, scene, replace(scene, seed=2))
    )
    assert (first == again).all()
    assert (first != other).any()


def test_camera_keeps_the_centre_of_a_dot():
    """Bayer interpolation, half the colour and JPEG do not move what was painted by more than some hundredths."""
    scene = LabScene((), (BlueDot(60.3, 58.8),), size_px=(128, 128), light_fall=0.0, exposure_s=0.0)
    for camera in (LabCamera(noise_levels=0.0), LabCamera(noise_levels=0.0, jpeg_quality=90)):
        image = replace(scene, camera=camera).frame(0.0).image.astype(float).mean(axis=2)
        weight = np.clip(image.max() - 8.0 - image, 0.0, None)
        rows, columns = np.indices(weight.shape)
        found = [(weight * columns).sum() / weight.sum(), (weight * rows).sum() / weight.sum()]
        assert found == pytest.approx([60.3, 58.8], abs=0.06)


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
