# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Whole runs: signs, symmetry, frames, and what goes wrong."""

import numpy as np
import pytest
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import ModelError, SimulationError
from hasel_sim.model import load_model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def test_the_upper_muscle_bends_the_swimmer_upwards(swimmer):
    """sin theta > 0 while the upper muscle contracts, and the mirror image while the lower does."""
    time = np.arange(61) / 120
    upper, lower = (
        simulate(swimmer, Run("", time, DriveSchedule(np.zeros(1), np.array([v])))).sin_theta
        for v in ([5500.0, 0.0], [0.0, 5500.0])
    )
    assert upper[-1] > 0.1
    assert lower == pytest.approx(-upper, abs=1e-6)


def test_polarity_does_not_matter(swimmer, boxes):
    """A HASEL contracts under either sign of the voltage."""
    run = boxes(duration=0.3)
    flipped = Run("", run.time, DriveSchedule(run.schedule.time, -run.schedule.signal))
    assert np.array_equal(simulate(swimmer, run).sin_theta, simulate(swimmer, flipped).sin_theta)


def test_without_voltage_nothing_moves(swimmer):
    """Beyond rounding."""
    found = simulate(swimmer, Run("", np.arange(30) / 120)).sin_theta
    assert np.abs(found).max() < 1e-10


def test_frames_before_the_release_are_missing_and_the_others_are_where_asked(swimmer):
    """NaN before initial_time; uneven frames give the same motion as even ones."""
    schedule = DriveSchedule(np.zeros(1), np.array([[5500.0, 0.0]]))
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


def test_a_contraction_beyond_reason_is_followed_or_reported_in_time(swimmer, boxes):
    """A quarter of the muscle's length at once is followed; half of it may be, or a sentence says what cannot."""
    model = swimmer.with_values({"amplitude_5500": 0.25, "slope": 1e3}).with_numerics(mesh_density=0.5)
    assert np.isfinite(simulate(model, boxes(duration=0.3)).sin_theta).all()
    try:
        found = simulate(model.with_values({"amplitude_5500": 0.5}), boxes(duration=0.3)).sin_theta
    except SimulationError as error:
        assert "the motion could not be followed beyond t = 0." in str(error)
    else:
        assert np.isfinite(found).all()


def test_shapes_are_kept_where_asked_for(swimmer, boxes):
    """One set of nodal positions per frame, starting with the reference."""
    found = simulate(swimmer, boxes(duration=0.1), keep_shapes=True)
    assert found.shapes.shape == (13, 275, 2)
    assert np.ptp(found.shapes[-1][:, 1]) > np.ptp(found.shapes[0][:, 1])


def test_halving_the_time_step_changes_little(swimmer, boxes):
    """At 5.5 kV, 2 Hz: mean |delta sin theta| below 0.001 between 240 and 960 steps per second."""
    run = boxes()
    coarse, fine = (
        simulate(swimmer.with_numerics(steps_per_second=s), run).sin_theta for s in (240.0, 960.0)
    )
    assert np.abs(coarse - fine).mean() < 1e-3


def test_a_run_without_frames_or_with_one_that_is_no_time_is_refused():
    """One sentence each, that says which."""
    with pytest.raises(SimulationError, match="run 'empty' has no frame; expected"):
        Run("empty", np.zeros(0))
    for time in (np.nan, np.inf):
        with pytest.raises(SimulationError, match=f"frame 2 of run 'broken' is at {time} s; expected finite"):
            Run("broken", np.array([0.0, time]))


def test_one_frame_is_the_state_at_rest_and_too_few_for_a_drive(swimmer, boxes):
    """Straight without a drive; with one, a sentence."""
    assert simulate(swimmer, Run("one", np.zeros(1))).sin_theta == pytest.approx(0.0, abs=1e-12)
    with pytest.raises(SimulationError, match="run 'one' is driven but has no frame after its start at 0 s"):
        simulate(swimmer, Run("one", np.zeros(1), boxes().schedule))


def test_a_held_shape_with_a_node_nowhere_is_refused():
    """One sentence."""
    shape = np.array([[0.0, 0.0], [np.nan, 0.0]])
    with pytest.raises(
        SimulationError, match="run 'held' starts has a node that is nowhere; expected finite"
    ):
        Run("held", np.arange(3.0), None, "held_shape", initial_shape=shape)


HARD = {"amplitude_5500": 0.2, "slope": 1e3}
"""A fifth of the muscle's length at once: some steps of 1/240 s cannot be followed."""


def test_a_step_that_cannot_be_followed_is_divided(swimmer, boxes):
    """The same motion as with four times as many steps; the derivatives are those of central differences."""
    model, run = swimmer.with_values(HARD).with_numerics(tolerance_m=1e-11), boxes(duration=0.34)
    found = simulate(model, run, ["amplitude_5500"])
    finer = simulate(model.with_numerics(steps_per_second=960.0), run).sin_theta
    assert np.abs(finer).max() > 0.8
    assert np.abs(found.sin_theta - finer).mean() < 0.02
    step = 1e-6
    above, below = (
        simulate(model.with_values({"amplitude_5500": 0.2 + sign * step}), run).sin_theta for sign in (1, -1)
    )
    expected = (above - below) / (2 * step)
    assert found.slopes[:, 0] == pytest.approx(expected, abs=2e-4 * np.abs(expected).max())


def test_a_heavy_tip_that_is_let_go_from_far_is_followed():
    """A trial shape on the way turns an element inside out; that ends the trial, not the simulation."""
    model = load_model("beam").with_effects("payload").with_values({"payload.mass": 1.7})
    model = model.with_numerics(mesh_density=0.5, quadrature_order=2, steps_per_second=120.0)
    run = Run("let go", np.arange(0.0, 0.2, 1 / 120), None, "static_equilibrium", 3.0)
    assert np.isfinite(simulate(model, run).sin_theta).all()


def test_a_driven_model_without_amplitudes_is_said():
    """It would stay straight without a word: with_levels was forgotten."""
    time = np.arange(5) / 120
    driven = Run("driven", time, DriveSchedule(np.zeros(1), np.array([[5500.0, 0.0]])))
    with pytest.warns(UserWarning, match="has no amplitudes"):
        simulate(load_model("swimmer"), driven)
