"""Errors of which neighbouring frames share most say less of their size than their number of frames."""

import numpy as np
import pytest
from hasel_sysid.selection.squares import surely_larger

RUNS = np.repeat([0, 1], 150)


def remembering(generator, memory):
    """Two series alike in size, each run with a start of its own."""
    series = generator.standard_normal((2, 300)) / np.sqrt(1 - memory**2)
    for frame in np.flatnonzero(np.diff(RUNS, prepend=-1) == 0):
        step = np.sqrt(1 - memory**2) * series[:, frame]
        series[:, frame] = memory * series[:, frame - 1] + step
    return series


@pytest.mark.parametrize("memory", [0.0, 0.7, 0.95])
def test_chance_makes_one_of_twenty_differ(memory):
    """By more than two standard errors, whatever the memory: not much more often, and not never."""
    generator = np.random.default_rng(8)
    beyond = [abs(surely_larger(*remembering(generator, memory), RUNS)) > 2 for _ in range(600)]
    assert 0.02 < np.mean(beyond) < 0.10


def test_what_is_twice_as_large_in_many_frames_is_larger():
    """White errors tell it at once, slow ones of the same length do not."""
    generator = np.random.default_rng(3)
    for memory, sure in ((0.0, True), (0.97, False)):
        one, other = remembering(generator, memory)
        one, other = one / np.linalg.norm(one), other / np.linalg.norm(other)
        assert (surely_larger(np.sqrt(2) * one, other, RUNS) > 2) is sure


def test_no_error_at_all_is_less_than_any():
    """A perfect fit is surely better, and two of them are equal."""
    nothing = np.zeros(300)
    assert surely_larger(np.ones(300), nothing, RUNS) == np.inf
    assert surely_larger(nothing, nothing, RUNS) == 0.0
