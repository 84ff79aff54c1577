# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a goal names: protocols of the literature, and files."""

from pathlib import Path

import pytest
from hasel_driver.nodes.experiment_goal import read_waveform
from hasel_driver.nodes.experiment_server import plan_of
from hasel_driver.protocol.faults import LimitError
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


BAD = {
    "rows 1 ms apart, and the driver sends one in 10 ms": "0,0,0\n0.001,100,0\n0.002,0,0",
    "more than 0 and at most 3600 s": "0,0,0\n4000,0,0",
    "above 9800 V": "0,0,0\n1,10000,0\n2,0,0",
}


@pytest.fixture
def write(tmp_path):
    """Writes rows as a file of the three columns."""

    def write(rows: str):
        path = tmp_path / "drive.csv"
        path.write_text(f"time_s,voltage_upper_v,voltage_lower_v\n{rows}\n")
        return path

    return write


@pytest.mark.parametrize("words", BAD)
def test_what_cannot_be_driven_is_refused(write, words):
    """Rows that the command period would skip, a drive that lasts too long, a voltage out of range."""
    with pytest.raises(LimitError, match=words):
        read_waveform(write(BAD[words]))


def test_each_row_holds_until_the_next(write):
    """From the first row's time, which counts as 0, to the last row's, which is the end."""
    drive = read_waveform(write("5,100,-200\n5.01,300,0\n5.5,0,0"))
    assert [drive.voltage(t) for t in (0.0, 0.005, 0.02, 0.51)] == [
        (100, -200),
        (100, -200),
        (300, 0),
        (0, 0),
    ]
    assert drive.duration_s == pytest.approx(0.5)
