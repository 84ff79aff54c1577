import pytest
from hasel_tracker_lab.bench.robustness import CASES, measure_robustness

FRAMES = 44


@pytest.mark.parametrize("case", CASES)
def test_no_false_angle_and_no_late_recovery(case):
    """Hidden, disturbed, turned round or out of the picture: never a wrong angle, and back with the first frame."""
    result = measure_robustness(case, FRAMES, width_px=960)
    assert (result.false_angles, result.late_frames) == (0, 0)
    assert result.unseen_frames >= 10 or case == "head on the right"
