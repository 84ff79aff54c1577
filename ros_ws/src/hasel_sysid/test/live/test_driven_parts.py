"""A long stream is cut at its rests."""

import numpy as np
import pytest
from hasel_sysid.live.driven_parts import driven_parts


def _stream(*driven: tuple[float, float], end: float) -> tuple[np.ndarray, np.ndarray, float]:
    time = np.arange(0.0, end, 0.01)
    on = np.any([(begin - 1e-9 <= time) & (time < stop - 1e-9) for begin, stop in driven], axis=0)
    return time, np.stack([5000.0 * on, np.zeros(len(time))], axis=1), end


def test_two_experiments_with_a_pause_are_two_parts():
    """Each with some rest before and its ringing after."""
    parts = driven_parts(*_stream((10.0, 12.0), (60.0, 61.0), end=100.0))
    assert parts == [pytest.approx((9.75, 13.0)), pytest.approx((59.75, 62.0))]


def test_the_half_periods_of_one_experiment_stay_together():
    """Short rests belong to the waveform."""
    parts = driven_parts(*_stream((1.0, 1.5), (2.0, 2.5), (3.0, 3.5), end=20.0))
    assert parts == [pytest.approx((0.75, 4.5))]


def test_parts_stay_within_the_stream():
    """Driven from the first to the last message."""
    assert driven_parts(*_stream((0.0, 1.0), end=1.0)) == [pytest.approx((0.0, 1.0))]


def test_a_body_never_driven_is_one_part():
    """A beam that was let go."""
    time = np.arange(100) * 0.01
    assert driven_parts(time, np.zeros((100, 2)), 1.0) == [(0.0, 1.0)]
