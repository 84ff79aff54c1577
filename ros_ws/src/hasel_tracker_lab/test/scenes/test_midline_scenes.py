"""Swimmers without dots in another renderer's pictures: right or not valid."""

import pytest
from hasel_tracker_lab.scenes.midline_catalogue import MIDLINE
from hasel_tracker_lab.scenes.wrong_while_valid import measure_honesty

BENCH_ONLY = (
    "midline: dark body, MJPEG 75",
    "midline: dark body, H.264 crf 28",
    "midline: dark body, defocus σ 2 px",
    "midline: exposure × 0.2",
    "midline: dark tank",
)
QUICK = [case for case in MIDLINE if case.name not in BENCH_ONLY]


@pytest.mark.parametrize("case", QUICK, ids=lambda case: case.name)
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
