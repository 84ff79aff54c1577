# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A load that hangs from a muscle and swings."""

import numpy as np
import pytest
from hasel_sim.errors import SimulationError
from hasel_sim.model.muscle_file import load_muscle
from hasel_sim.muscle.swing import GRAVITY, HangingLoad, force_table

LOAD = 0.06 * GRAVITY


@pytest.fixture(scope="module")
def muscle():
    """With a stiffness of its own."""
    return (
        load_muscle("peano_hasel")
        .with_effects("parallel_stiffness")
        .with_values({"parallel_stiffness.stiffness": 30.0})
    )


def _lifted(muscle, volts: float, seconds: float = 3.0, **losses: float) -> tuple[np.ndarray, np.ndarray]:
    time = np.arange(0.0, seconds, 2e-4)
    return time, HangingLoad(muscle, LOAD, 6000.0, **losses).contraction(time, np.full(len(time), volts))


@pytest.mark.parametrize("volts", [2500.0, 4000.0, 6000.0])
def test_it_settles_where_forces_balance(muscle, volts):
    """At the contraction of the static law, to the table's resolution; without voltage it stays where it is."""
    _, x = _lifted(muscle, volts, damping=2.0)
    settled = muscle.balanced(np.array([volts]), np.array([LOAD]), np.array([LOAD]))[0]
    assert x[-1] == pytest.approx(settled, rel=5e-3, abs=2e-5)
    assert x.max() > 1.3 * settled
    assert np.all(_lifted(muscle, 0.0, 0.5)[1] == 0.0)


def test_a_load_that_is_thrown_up_flies_as_a_stone(muscle):
    """Where the muscle is slack the load slows down by g, less what the muscle's own mass takes part in."""
    time, x = _lifted(muscle, 6000.0, 0.2)
    hanging = HangingLoad(muscle, LOAD, 6000.0)
    top = int(np.argmax(x))
    around = slice(top - 40, top + 40)
    acceleration = 2 * np.polyfit(time[around], x[around], 2)[0]
    assert acceleration == pytest.approx(-LOAD / hanging.mass, rel=0.02)


def test_small_swings_have_the_frequency_of_mass_and_slope(muscle):
    """Against the square root of the law's stiffness by the mass."""
    volts = 4000.0
    loads = LOAD + np.array([-5e-3, 5e-3])
    high, low = muscle.balanced(np.full(2, volts), loads, np.full(2, LOAD))
    hanging = HangingLoad(muscle, LOAD, volts)
    expected = np.sqrt(1e-2 / (high - low) / hanging.mass) / (2 * np.pi)
    time, x = _lifted(muscle, volts, 2.0, damping=0.5)
    small = np.abs(x - x[-1]) > 2e-4
    late = time > time[small][-1]
    y = x[late] - x[-1]
    assert np.abs(y).max() > 1e-4
    crossings = np.flatnonzero((y[:-1] < 0) & (y[1:] >= 0))
    found = 1.0 / np.diff(time[late][crossings])[:3].mean()
    assert found == pytest.approx(expected, rel=0.05)


def test_the_table_is_the_law(muscle):
    """Between its points too."""
    table = force_table(muscle, LOAD, 6000.0)
    volts, x = 6000.0 * np.sqrt(10 / 32), 100 / 240 * table.largest_contraction
    expected = muscle.force(np.zeros(1), np.array([volts]), np.array([x]), LOAD)[0]
    assert table.newtons[10, 100] == pytest.approx(expected, rel=1e-6)


def test_a_voltage_beyond_the_table_is_refused(muscle):
    """With both numbers."""
    with pytest.raises(SimulationError, match="goes to 7000 V; expected at most the 6000 V"):
        _lifted(muscle, 7000.0)
