# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Box voltages of two muscles."""

import numpy as np
import pytest
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model
from hasel_sim.swimming.boxes import Boxes

PAIR = ("upper", "lower")


def test_the_muscles_take_turns():
    """Each at its voltage for half of every period, never both."""
    schedule = Boxes(5500.0, 4800.0, 2.0).schedule(2.0, PAIR)
    middles = np.arange(0.125, 2.0, 0.25)
    expected = [[5500.0, 0.0], [0.0, 4800.0]] * 4
    assert schedule.at(middles).tolist() == expected
    assert schedule.switches() == pytest.approx(np.arange(0.0, 2.1, 0.25))


def test_duty_and_phase():
    """A duty below one leaves gaps; a phase of a quarter makes the boxes overlap."""
    schedule = Boxes(1.0, 1.0, 1.0, duty=0.5).schedule(1.0, PAIR)
    assert schedule.at(np.array([0.1, 0.3, 0.6, 0.8])).tolist() == [[1, 0], [0, 0], [0, 1], [0, 0]]
    early = Boxes(1.0, 1.0, 1.0, phase=0.25).schedule(2.0, PAIR)
    assert early.at(np.array([0.1, 0.3, 0.6, 0.8])).tolist() == [[1, 0], [1, 1], [0, 1], [0, 0]]


def test_what_cannot_swim_is_refused():
    """A body without muscles, and a run too short to settle."""
    with pytest.raises(SimulationError, match="is driven by nothing; expected two voltages"):
        Boxes(1.0, 1.0, 1.0).run(load_model("beam"), 10.0)
    with pytest.raises(SimulationError, match="2 s hold 2 periods of 1 Hz; expected at least 4"):
        Boxes(1.0, 1.0, 1.0).run(load_model("swimmer"), 2.0)
