"""Where an effect is looked at beside a set, from what it did beside the baseline."""

from collections.abc import Callable

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sysid.candidates import Start, starts
from hasel_sysid.diagnosis.trial import Trial
from hasel_sysid.selection.sets import FittedSet
from hasel_sysid.selection.sized_starts import Expected, expected_beside, overlooked
from hasel_sysid.testing.made_up_runs import made_up_trial

SHAPE = np.sin(np.linspace(0.0, 9.0, 200))
BASELINE = 2.0 * SHAPE
RATE = "linear_drag.rate"


def trial_of(response: Callable[[float], float], at: Start) -> Trial:
    """Of a drag whose series is the response to its rate times a shape."""
    rate = at.values[RATE]
    slope = (response(rate + 1e-6) - response(rate - 1e-6)) / 2e-6
    residual = BASELINE - response(rate) * SHAPE
    return made_up_trial(load_model("beam"), at, dict(at.values), residual, (slope * SHAPE)[:, None], 0.0)


def expected_of(response: Callable[[float], float], left: float) -> Expected:
    """That of this drag beside a set that leaves so much of the shape."""
    trial = trial_of(response, starts(catalogue()["linear_drag"])[0])
    none = np.zeros((len(SHAPE), 0))
    beside = FittedSet(frozenset({"payload"}), left * SHAPE, none, np.zeros(0), np.zeros(0), (), {})
    (found,) = expected_beside(beside, [trial], BASELINE)
    return found


def start_of(response: Callable[[float], float], left: float) -> Start:
    """Where it is looked at first."""
    return expected_of(response, left).begin


def test_what_acts_in_proportion_starts_without_effect():
    """From there its derivative leads to any size."""
    assert start_of(lambda rate: 0.5 * rate, left=0.5).values == {RATE: 0.0}


def test_what_saturates_starts_at_the_size_that_is_expected():
    """Four fifths of what it does at its typical size are missing."""
    typical = catalogue()["linear_drag"].parameters[0].typical
    found = start_of(lambda rate: np.tanh(8.0 * rate / typical), left=0.8)
    assert found.values == {RATE: pytest.approx(0.8 * typical)}


def test_a_small_size_is_no_reason_to_start_what_bends_without_effect():
    """Its derivative there may be none, as that of a lag behind the slowest rise, and then it promises nothing."""
    typical = catalogue()["linear_drag"].parameters[0].typical
    found = start_of(lambda rate: (rate / typical) ** 3, left=0.2)
    assert found.values == {RATE: pytest.approx(0.2 * typical)}


def test_what_shows_too_little_where_it_does_nothing_is_looked_at_at_its_size_as_well():
    """Beside the baseline first order nearly leads back; beside the set there is no slope where it does nothing."""
    typical = catalogue()["linear_drag"].parameters[0].typical
    one = expected_of(lambda rate: rate / typical, left=0.6)
    assert one.begin.values == {RATE: 0.0}
    hidden = trial_of(lambda rate: max(0.0, rate / typical - 0.3) / 0.7, one.begin)
    (found,) = overlooked([one], [hidden])
    assert found.values == {RATE: pytest.approx(0.6 * typical)}


@pytest.mark.parametrize("slope", [0.6, 1.0, 4.0])
def test_what_shows_where_it_does_nothing_is_looked_at_there_only(slope):
    """A little less than beside the baseline, as much, or more."""
    typical = catalogue()["linear_drag"].parameters[0].typical
    one = expected_of(lambda rate: rate / typical, left=0.6)
    assert overlooked([one], [trial_of(lambda rate: slope * rate / typical, one.begin)]) == []
