"""What a tracked run says of itself."""

import numpy as np
from hasel_tracker.offline.tracked_run import TrackedRun


def run_of(sin_theta: list[float]) -> TrackedRun:
    """Some frames at 120 per second."""
    sines = np.array(sin_theta)
    count = len(sines)
    return TrackedRun(
        np.arange(count) / 120.0, sines, np.arcsin(sines), np.zeros((count, 3, 2)), np.ones((count, 3))
    )


def test_one_frame_has_no_rate():
    """A run of one frame says so rather than "nan frames/s"; one without an angle has no range of angles."""
    assert str(run_of([0.1])) == "1 frame, 0 without an angle; sin θ from +0.1000 to +0.1000."
    assert str(run_of([np.nan])) == "1 frame, an angle in none of them."
    assert str(run_of([0.1, np.nan, -0.2])).startswith(
        "3 frames at 120 frames/s, 1 without an angle; sin θ from -0.2"
    )
