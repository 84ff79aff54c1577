"""How near a model must be for its derivatives to be followed."""

import numpy as np
import pytest
from hasel_sysid.estimation.opening import in_step, is_close, is_small
from hasel_sysid.testing.made_up_runs import made_up_evaluation

TIME = np.arange(100.0)
MOTION = np.sin(TIME) - np.sin(TIME).mean()


def _model_that_moves(share: float):
    """It moves like the body, but so many times as far."""
    return made_up_evaluation((1 - share) * MOTION[None], TIME, simulated=share * MOTION)


def test_an_error_is_small_up_to_a_seventh_of_the_motion():
    """Whatever the unit."""
    assert is_small(0.14 * MOTION, MOTION)
    assert not is_small(0.16 * MOTION, MOTION)
    assert is_small(1e6 * 0.14 * MOTION, 1e6 * MOTION)


@pytest.mark.parametrize(("share", "close"), [(0.86, True), (0.84, False), (1.14, True), (1.16, False)])
def test_a_model_is_close_by_what_was_measured(share, close):
    """Not by its own motion: one that moves too far is no closer than one that moves too little."""
    assert is_close(_model_that_moves(share)) == close


@pytest.mark.parametrize(("share", "expected"), [(0.31, True), (0.28, False), (1.69, True), (1.72, False)])
def test_a_model_is_in_step_while_it_leaves_less_than_half_of_the_measured_power(share, expected):
    """It leaves the square of the share that it misses."""
    assert in_step(_model_that_moves(share)) == expected


def test_what_was_measured_is_what_was_simulated_and_what_is_left():
    """The mean of every run removed."""
    np.testing.assert_allclose(_model_that_moves(0.4).measured(), MOTION, atol=1e-15)
