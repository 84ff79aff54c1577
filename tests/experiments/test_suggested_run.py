# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The run that `suggest` simulates is the run that its goal makes the driver drive."""

import numpy as np
import pytest
from hasel_driver.protocol.waveform import Waveform
from hasel_sysid.answer.next_run import Manoeuvre


def driven(goal, time):
    """What the driver puts on both muscles [V] [n, 2] at times [s] [n] after the start of a goal."""
    waveform = Waveform(
        goal["waveform"],
        goal["voltage"],
        goal["frequency"],
        goal["periods"],
        duty=goal["duty"],
        polarity=goal["polarity"],
        muscles=goal["muscles"],
    )
    return np.array([waveform.voltage(t) for t in time])


@pytest.mark.parametrize("muscles", ["both", "upper", "lower"])
@pytest.mark.parametrize("waveform", ["box", "triangle", "sine"])
def test_the_simulated_voltage_is_the_driven_one(waveform, muscles):
    """Duty, polarity and the half of the period in which each muscle is driven, at every frame but the switches."""
    manoeuvre = Manoeuvre(4500.0, 1.5, 3, waveform, muscles)
    run = manoeuvre.run()
    time = run.time + 1e-6
    step = 4500.0 * 2 * np.pi * 1.5 / 120.0
    expected = driven(manoeuvre.goal(), time)
    assert np.abs(run.schedule.at(time)[:, :2] - expected).max() <= step
    assert expected.max() == pytest.approx(4500.0, rel=0.01)


def test_every_supply_can_drive_it():
    """A supply of one polarity too."""
    assert Manoeuvre(4500.0, 1.5, 3, "box", "both").goal()["polarity"] == "positive"
