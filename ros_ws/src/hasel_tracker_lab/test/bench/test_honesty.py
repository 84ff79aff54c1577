# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Scenes in which a wrong angle was once called valid, pictures of real laboratories, and swimmers without dots."""

from dataclasses import replace

import pytest
from hasel_tracker_lab.bench.honesty import measure_honesty
from hasel_tracker_lab.scenes.scene_catalogue import ADVERSARIAL, MIDLINE, REAL
from hasel_tracker_lab.scenes.unforeseen import DECEIVING, UNFORESEEN

QUICK = (
    "electrodes, H.264 crf 28", "textured ground", "exposure × 0.2", "dark tank", "dark body", "dots of 10 px",
    "640 × 480, dots of 12 px", "30 frames/s, 4 Hz",
)  # fmt: skip
BENCH_ONLY = (
    "midline: dark body, MJPEG 75",
    "midline: dark body, H.264 crf 28",
    "midline: dark body, defocus σ 2 px",
    "midline: exposure × 0.2",
    "midline: dark tank",
)
QUICK_MIDLINE = [case for case in MIDLINE if case.name not in BENCH_ONLY]


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


@pytest.mark.parametrize("case", QUICK_MIDLINE, ids=lambda case: case.name)
def test_the_centre_line_gives_the_right_angle_or_none(case):
    """No valid angle is off by more than 0.01; where one is due hardly a frame is lost; elsewhere none is given."""
    honesty = measure_honesty(case, case.least_frames if case.least_frames > 8 else 4)
    assert honesty.wrong == 0, str(honesty)
    if case.expected:
        assert honesty.lost_share < 0.1, str(honesty)
        assert honesty.rms_px < 1.0
        assert honesty.sin_theta_rms < 3e-3
    else:
        assert honesty.valid == 0, str(honesty)
