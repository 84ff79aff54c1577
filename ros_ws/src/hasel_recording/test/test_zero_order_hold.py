"""Values hold until the next."""

import numpy as np
from hasel_recording.zero_order_hold import held, row_in_force
from hypothesis import given
from hypothesis import strategies as st

TIMES = np.array([1.0, 2.0, 4.0])


def test_a_value_holds_from_its_own_instant_to_the_next():
    """At the instant itself the new one is in force; nothing is before the first, and the last one stays."""
    at = np.array([0.5, 1.0, 1.999, 2.0, 4.0, 99.0])
    assert row_in_force(TIMES, at).tolist() == [-1, 0, 0, 1, 2, 2]
    assert held(TIMES, np.array([3.0, 5.0, 7.0]), at).tolist() == [0, 3, 3, 5, 7, 7]


def test_several_channels_and_a_value_that_is_not_known():
    """Rows go together, and NaN is in force like any other."""
    values = np.array([[1.0, 2.0], [np.nan, np.nan], [3.0, 4.0]])
    found = held(TIMES, values, np.array([0.0, 1.5, 2.5, 5.0]))
    np.testing.assert_array_equal(found, [[0, 0], [1, 2], [np.nan, np.nan], [3, 4]])


def test_one_instant():
    """As a waveform asks."""
    assert row_in_force(TIMES, 2.5) == 1


@given(st.lists(st.floats(0.0, 5.0), min_size=1, max_size=20))
def test_the_last_of_all_that_came_so_far_is_in_force(at):
    """As one would look it up by hand."""
    values = np.array([3.0, 5.0, 7.0])
    by_hand = [([0.0, *values[t >= TIMES]])[-1] for t in at]
    assert held(TIMES, values, np.array(at)).tolist() == by_hand
