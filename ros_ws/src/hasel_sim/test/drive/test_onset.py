"""The instants at which a drive begins or ceases to contract."""

import numpy as np
from hasel_sim.drive.onset import crossings, with_onsets
from numpy.testing import assert_allclose


def _with(time, signal, onsets):
    return with_onsets(time, signal, onsets, crossings(time, signal, onsets))


def test_a_crossing_gets_an_instant_and_a_jump_does_not():
    """Up, down on the negative side, and past the onset at once."""
    time = np.array([0.0, 1.0, 2.0, 2.0, 3.0])
    signal = np.array([[0.0], [4.0], [4.0], [-4.0], [0.0]])
    found, rows = _with(time, signal, np.array([1.0]))
    assert_allclose(found, [0.0, 0.25, 1.0, 2.0, 2.0, 2.75, 3.0])
    assert_allclose(rows[:, 0], [0.0, 1.0, 4.0, 4.0, -4.0, -1.0, 0.0])


def test_channels_that_cross_between_the_same_times_are_put_in_order():
    """The second is at its onset first; each one's row holds where the other is meanwhile."""
    found, rows = _with(np.array([0.0, 1.0]), np.array([[0.0, 0.0], [10.0, 10.0]]), np.array([8.0, 2.0]))
    assert_allclose(found, [0.0, 0.2, 0.8, 1.0])
    assert_allclose(rows, [[0.0, 0.0], [2.0, 2.0], [8.0, 8.0], [10.0, 10.0]])


def test_without_an_onset_nothing_is_added():
    """A drive that contracts from 0 V on has no corner."""
    time, signal = np.linspace(0, 1, 5), np.linspace(0, 1, 5)[:, None]
    found, rows = _with(time, signal, np.zeros(1))
    assert_allclose(found, time)
    assert_allclose(rows, signal)
