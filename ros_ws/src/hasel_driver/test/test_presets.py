"""Protocols by their name."""

from pathlib import Path

import pytest
from hasel_driver.errors import LimitError
from hasel_driver.experiment_server import plan_of
from hasel_interfaces.action import RunExperiment


def goal(**given):
    """A goal with the interface's own defaults, but for what is given."""
    return RunExperiment.Goal(**given)


def test_three_lifts_are_those_of_the_paper():
    """Three times 5 s on and 5 s off, the polarity reversed every time, on one muscle, with rests around it."""
    plan = plan_of(goal(preset=RunExperiment.Goal.THREE_LIFTS, voltage=5000.0), Path())
    assert (plan.duration_s, plan.rest_s) == (40.0, 5.0)
    lifted = [plan.waveform.voltage(t) for t in (0.1, 4.9, 5.1, 9.9, 10.1, 15.1, 20.1, 24.9, 25.1)]
    volts = [5000.0, 5000.0, 0.0, 0.0, -5000.0, 0.0, 5000.0, 5000.0, 0.0]
    assert lifted == [(each, 0.0) for each in volts]


def test_muscle_and_rest_remain_open():
    """The lower muscle and a longer rest may be asked for."""
    plan = plan_of(goal(preset="three_lifts", voltage=1000.0, muscles="lower", rest_time=8.0), Path())
    assert plan.waveform.voltage(0.1) == (0.0, 1000.0)
    assert plan.rest_s == 8.0


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"preset": "four_lifts"}, "'four_lifts', three_lifts or nothing was expected"),
        ({"preset": "three_lifts", "voltage": 2e4}, "voltage_v is 20000"),
        ({"preset": "three_lifts", "muscles": "lower_first"}, "A bench holds one muscle"),
        ({"preset": "three_lifts", "waveform_file": "a.csv"}, "give one of the two"),
    ],
)
def test_what_cannot_be_is_refused(given, message):
    """Unknown names, voltages out of range and contradictions get a sentence."""
    with pytest.raises(LimitError, match=message):
        plan_of(goal(**given), Path())


def test_a_supply_of_one_polarity_refuses_it():
    """Reversed polarity is part of the protocol: a supply that cannot do it says so, and gives nothing."""
    plan = plan_of(goal(preset="three_lifts", voltage=5000.0), Path())
    with pytest.raises(LimitError, match="positive voltages only"):
        plan.check_against(10_000.0, bipolar=False)
