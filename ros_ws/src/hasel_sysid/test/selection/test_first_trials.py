"""Where an effect is looked at beside a set, from what it did beside the baseline."""

from collections.abc import Callable

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sysid.diagnosis.candidates import Start, starts
from hasel_sysid.selection.first_trials import sized_starts
from hasel_sysid.selection.sets import FittedSet
from hasel_sysid.testing.made_up_runs import made_up_trial

SHAPE = np.sin(np.linspace(0.0, 9.0, 200))
BASELINE = 2.0 * SHAPE
RATE = "linear_drag.rate"


def start_of(response: Callable[[float], float], left: float) -> Start:
    """That of a drag beside a set that leaves so much of a shape, where the drag's series is the response to its rate
    times that shape.
    """
    start = starts(catalogue()["linear_drag"])[0]
    rate = start.values[RATE]
    slope = (response(rate + 1e-6) - response(rate - 1e-6)) / 2e-6
    residual = BASELINE - response(rate) * SHAPE
    trial = made_up_trial(
        load_model("beam"), start, dict(start.values), residual, (slope * SHAPE)[:, None], 0.0
    )
    none = np.zeros((len(SHAPE), 0))
    beside = FittedSet(frozenset({"payload"}), left * SHAPE, none, np.zeros(0), np.zeros(0), (), {})
    (found,) = sized_starts(beside, [trial], BASELINE)
    return found


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
