"""Whole runs: signs, symmetry, frames, and what goes wrong."""

import numpy as np
import pytest
from hasel_sim.drive.voltage import VoltageSchedule
from hasel_sim.errors import ModelError, SimulationError
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def test_the_upper_muscle_bends_the_swimmer_upwards(swimmer):
    """sin theta > 0 while the upper muscle contracts, and the mirror image while the lower does."""
    time = np.arange(61) / 120
    upper, lower = (
        simulate(swimmer, Run("", time, VoltageSchedule(np.zeros(1), np.array([v])))).sin_theta
        for v in ([5500.0, 0.0], [0.0, 5500.0])
    )
    assert upper[-1] > 0.1
    assert lower == pytest.approx(-upper, abs=1e-6)


def test_polarity_does_not_matter(swimmer, boxes):
    """A HASEL contracts under either sign of the voltage."""
    run = boxes(duration=0.3)
    flipped = Run("", run.time, VoltageSchedule(run.schedule.time, -run.schedule.voltage))
    assert np.array_equal(simulate(swimmer, run).sin_theta, simulate(swimmer, flipped).sin_theta)


def test_without_voltage_nothing_moves(swimmer):
    """Not even by rounding."""
    found = simulate(swimmer, Run("", np.arange(30) / 120)).sin_theta
    assert np.abs(found).max() < 1e-12


def test_frames_before_the_release_are_missing_and_the_others_are_where_asked(swimmer):
    """NaN before initial_time; uneven frames give the same motion as even ones."""
    schedule = VoltageSchedule(np.zeros(1), np.array([[5500.0, 0.0]]))
    time = np.array([-0.2, -0.1, 0.0, 0.1, 0.13, 0.3])
    found = simulate(swimmer, Run("", time, schedule, initial_time=0.0))
    even = simulate(swimmer, Run("", np.arange(37) / 120, schedule))
    assert np.isnan(found.sin_theta[:2]).all()
    assert found.sin_theta[2:] == pytest.approx(np.interp(time[2:], even.time, even.sin_theta), abs=5e-4)


def test_a_run_without_frames_after_its_start_is_refused(swimmer):
    """The sentence names the run."""
    with pytest.raises(SimulationError, match="'late' has no frame after"):
        simulate(swimmer, Run("late", np.array([0.0, 0.1]), initial_time=3.0))


def test_an_unknown_parameter_is_refused_with_the_nearest_name(swimmer, boxes):
    """One sentence."""
    with pytest.raises(ModelError, match="the nearest known one is 'slope'"):
        simulate(swimmer, boxes(), ["slop"])


def test_a_contraction_beyond_reason_is_reported_and_not_followed_for_ever(swimmer, boxes):
    """Newton gives up with a sentence."""
    model = swimmer.with_values({"amplitude_5500": 5.0, "slope": 1e3})
    with pytest.raises(SimulationError, match="could not be followed beyond t ="):
        simulate(model, boxes())


def test_shapes_are_kept_where_asked_for(swimmer, boxes):
    """One set of nodal positions per frame, starting with the reference."""
    found = simulate(swimmer, boxes(duration=0.1), keep_shapes=True)
    assert found.shapes.shape == (13, 336, 2)
    assert np.ptp(found.shapes[-1][:, 1]) > np.ptp(found.shapes[0][:, 1])


def test_halving_the_time_step_changes_little(swimmer, boxes):
    """At 5.5 kV, 2 Hz: mean |delta sin theta| below 0.001 between 240 and 960 steps per second."""
    run = boxes()
    coarse, fine = (
        simulate(swimmer.with_numerics(steps_per_second=s), run).sin_theta for s in (240.0, 960.0)
    )
    assert np.abs(coarse - fine).mean() < 1e-3
