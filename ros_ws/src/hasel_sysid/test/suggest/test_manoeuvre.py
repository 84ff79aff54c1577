"""The library of experiments."""

import numpy as np
import pytest
from hasel_interfaces.action import RunExperiment
from hasel_recording import DriveChannel
from hasel_sysid.suggest import Manoeuvre, manoeuvres


def test_goals_fit_the_action():
    """Every field of a goal is one of the action's, and takes the value."""
    goal = RunExperiment.Goal(**Manoeuvre(4500.0, 2.0, 3, "triangle", "upper").goal())
    assert (goal.voltage, goal.frequency, goal.periods, goal.waveform) == (4500.0, 2.0, 3, "triangle")


def test_no_voltage_exceeds_the_safe_maximum():
    """Neither by choice nor at the peak of a waveform."""
    library = manoeuvres(np.array([3500.0, 4500.0, 5500.0]), 4600.0)
    assert library
    assert max(np.abs(m.run().schedule.signal).max() for m in library) <= 4600.0


@pytest.mark.parametrize("waveform", ["box", "triangle", "sine"])
def test_muscles_take_turns(waveform):
    """The two muscles are never driven together, and each gets the whole voltage once a period."""
    voltage = Manoeuvre(5000.0, 1.0, 2, waveform, "both").run().schedule.signal
    assert not np.any((voltage[:, 0] > 0) & (voltage[:, 1] > 0))
    assert voltage.max(axis=0) == pytest.approx([5000.0, 5000.0], rel=0.02)


def test_single_muscle_leaves_the_other_grounded():
    """Only the upper muscle sees a voltage."""
    voltage = Manoeuvre(5000.0, 1.0, 2, "box", "upper").run().schedule.signal
    assert voltage[:, 0].max() == 5000.0
    assert not voltage[:, 1].any()


def test_passive_bodies_are_held_and_let_go():
    """Without muscles the load under which the body is held is what can be chosen."""
    library = manoeuvres(np.zeros(0), 5500.0)
    assert {m.run().initial_state for m in library} == {"static_equilibrium"}
    assert len({m.load_factor for m in library}) == len(library)


def test_other_channels_are_driven_in_their_own_unit():
    """A chamber is filled for half the period; three channels take turns; both are said in their unit."""
    chamber = (DriveChannel("chamber", "pressure", "Pa"),)
    library = manoeuvres(np.array([10000.0, 25000.0]), 25000.0, channels=chamber)
    assert {m.muscles for m in library} == {"both"}
    one = Manoeuvre(25000.0, 1.0, 2, "box", "both", channels=chamber)
    assert one.run().schedule.signal[:, 0].tolist() == [25000.0, 0.0, 25000.0, 0.0]
    assert str(one) == "box of 25000 Pa at 1 Hz, 2 periods, chamber only"
    assert one.goal()["channels"] == ["pressure_chamber_pa"]
    three = tuple(DriveChannel(name, "voltage", "V") for name in ("root", "middle", "tip"))
    for waveform in ("box", "triangle"):
        signal = Manoeuvre(5000.0, 1.0, 2, waveform, "both", channels=three).run().schedule.signal
        assert np.count_nonzero(signal, axis=1).max() == 1
        assert signal.max(axis=0) == pytest.approx([5000.0] * 3, rel=0.05)
