"""Scenes of another renderer in which a wrong angle was once called valid, and pictures of real laboratories."""

from dataclasses import replace

import pytest
from hasel_tracker_lab.scenes.catalogue import ADVERSARIAL, REAL
from hasel_tracker_lab.scenes.unforeseen import DECEIVING, UNFORESEEN
from hasel_tracker_lab.scenes.wrong_while_valid import measure_honesty

QUICK = (
    "electrodes, H.264 crf 28", "textured ground", "exposure × 0.2", "dark tank", "dark body", "dots of 10 px",
    "640 × 480, dots of 12 px", "30 frames/s, 4 Hz",
)  # fmt: skip


@pytest.mark.parametrize("case", ADVERSARIAL, ids=lambda case: case.name)
def test_no_wrong_angle_is_called_valid(case):
    """Whatever else is blue, hidden, reflected or alike at both ends: no valid angle is off by more than 0.01."""
    honesty = measure_honesty(case, case.least_frames, 2 if case.least_frames < 10 else 1)
    assert honesty.wrong == 0, str(honesty)
    if case.expected:
        assert honesty.lost_share <= 0.5, str(honesty)
    if (
        case.name.startswith(("no swimmer", "three blue dots", "two swimmers"))
        or case.name == "body without taper"
    ):
        assert honesty.valid == 0, str(honesty)


@pytest.mark.parametrize("case", UNFORESEEN, ids=lambda case: case.name)
def test_scenes_without_a_rule_of_their_own(case):
    """Hands, cables, glare, bubbles, rulers, anywhere over a swimmer anywhere: no wrong angle is called valid."""
    honesty = measure_honesty(case, 10)
    assert honesty.wrong == 0, str(honesty)
    if case.expected:
        assert honesty.valid, str(honesty)


@pytest.mark.parametrize(
    ("case", "drawing", "frames"),
    [(DECEIVING[0], 10, 6), (DECEIVING[0], 11, 9), (DECEIVING[0], 19, 6), (DECEIVING[1], 4, 11), (DECEIVING[2], 5, 10),
     (DECEIVING[2], 7, 7)],
    ids=["beside the body", "within the body's ends", "beside the axis", "short of the nose", "where bodies cross",
         "another body alongside"],
)  # fmt: skip
def test_what_takes_a_markers_place_is_not_taken_for_it(case, drawing, frames):
    """A loose dot where no marker of a whole body would be, or a body along another, gives no angle."""
    honesty = measure_honesty(replace(case, scene=lambda _: case.scene(drawing)), frames)
    assert honesty.wrong == 0, str(honesty)


@pytest.mark.parametrize("case", [each for each in REAL if each.name in QUICK], ids=lambda case: case.name)
def test_pictures_of_real_laboratories_are_tracked(case):
    """Compressed, dark, small, coarse or textured pictures on default settings: hardly a frame is lost, none wrong."""
    honesty = measure_honesty(case, 10)
    assert (honesty.wrong, honesty.lost_share) == (0, pytest.approx(0.0, abs=0.11)), str(honesty)
    assert honesty.rms_px < 0.3
    assert honesty.sin_theta_rms < 3e-3


def test_the_standard_deviation_from_the_picture_is_about_the_error():
    """Of noisy pictures without structure by the dots, σ of sin θ is within a factor of three of the true error."""
    case = next(each for each in REAL if each.name == "Bayer, 4:2:0, noise")
    honesty = measure_honesty(case, 12)
    assert honesty.sin_theta_rms / 3 < honesty.sin_theta_std < 3 * honesty.sin_theta_rms
