import numpy as np
import pytest
from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.movement import cut_to_periods, first_movement_s
from hasel_tracker.offline.tracked_run import TrackedRun

TIMES = np.arange(360) / 120.0


def beat(start_s: float, noise: float = 0.0, frequency_hz: float = 2.0) -> np.ndarray:
    """sin θ of a body that rests at 0.05 and beats from `start_s` on."""
    active = np.maximum(TIMES - start_s, 0.0)
    return (
        0.05
        + 0.3 * np.sin(2.0 * np.pi * frequency_hz * active)
        + noise * np.random.default_rng(1).normal(size=360)
    )


def run_of(sin_theta: np.ndarray) -> TrackedRun:
    """A run with this angle."""
    return TrackedRun(TIMES, sin_theta, np.arcsin(sin_theta), np.zeros((360, 3, 2)), np.ones((360, 3)))


@pytest.mark.parametrize("start_s", [0.1, 0.4, 1.0])
@pytest.mark.parametrize("noise", [0.0, 5e-4])
def test_first_movement_to_a_frame(start_s, noise):
    """The first movement is found to one frame, with and without noise."""
    assert first_movement_s(TIMES, beat(start_s, noise)) == pytest.approx(start_s, abs=1.01 / 120.0)


def test_lost_frames_and_a_single_outlier_are_passed_over():
    """Frames without an angle, or one wrong one, are not taken for movement."""
    sin_theta = beat(0.5)
    sin_theta[20:25] = np.nan
    sin_theta[40] = 0.4
    assert first_movement_s(TIMES, sin_theta) == pytest.approx(0.5, abs=1.01 / 120.0)


def test_cut_keeps_two_periods():
    """The seed's cut: from the first movement, two periods of the drive."""
    cut = cut_to_periods(run_of(beat(0.4)), 2.0)
    assert len(cut.time_s) == 120
    assert cut.time_s[0] == pytest.approx(0.4, abs=1.01 / 120.0)


@pytest.mark.parametrize(
    ("sin_theta", "frequency_hz", "message"),
    [
        (beat(9.0), 2.0, "never moves more than"),
        (beat(0.0), 2.0, "moves within the first 6 frames"),
        (beat(1.0), 0.5, "less than 2 periods of 0.5 Hz"),
        (beat(1.0), 0.0, "expected positive numbers"),
    ],
)
def test_impossible_cuts_are_explained(sin_theta, frequency_hz, message):
    """No movement, movement from the start, too short a run: each is said."""
    with pytest.raises(TrackerError, match=message):
        cut_to_periods(run_of(sin_theta), frequency_hz)
