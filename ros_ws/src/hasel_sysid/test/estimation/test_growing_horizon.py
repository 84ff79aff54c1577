"""Fits from so far away that a model is out of phase within a few swings (cycle skipping)."""

import numpy as np
import pytest
from hasel_recording import Recording
from hasel_sim.model import Model, load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from hasel_sysid.dataset import Experiment
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.estimation.fit import exact, fitted_model
from hasel_sysid.estimation.growing_horizon import horizons, in_phase, length
from hasel_sysid.problem import Problem
from hasel_sysid.testing.formula_problem import FormulaProblem
from hasel_sysid.testing.made_up_runs import made_up_evaluation

RUN = Run("let go", np.arange(0.0, 1.5, 0.01), None, "static_equilibrium", 1.5)
TIME = np.arange(0.0, 3.0, 0.01)
STIFFNESS = "material.soft.youngs_modulus_pa"
MOTION = np.sin(np.arange(100.0)) - np.sin(np.arange(100.0)).mean()


def oscillator(model: Model, time: np.ndarray) -> np.ndarray:
    """A body that is let go at 3 Hz for the file's stiffness."""
    rate = 6 * np.pi * np.sqrt(max(model.values[STIFFNESS], 1.0) / 264e3)
    return 0.2 * np.exp(-0.4 * time) * np.cos(rate * time)


@pytest.fixture
def stiffness_free() -> Model:
    """A beam whose stiffness is fitted."""
    return load_model("beam").with_freed(STIFFNESS)


@pytest.mark.parametrize("share", [0.4, 2.5])
def test_a_wrong_frequency_is_brought_into_phase(stiffness_free, share):
    """Five swings apart at the end of the run, where no derivative leads back: one swing first, then two, four..."""
    truth = stiffness_free.with_values({STIFFNESS: 264e3 * share})
    noise = 0.002 * np.random.default_rng(0).standard_normal(len(TIME))
    problem = FormulaProblem(oscillator, TIME, oscillator(truth, TIME) + noise)
    stuck = exact(problem, fitted_model(problem.evaluate(stiffness_free, (STIFFNESS,))))
    assert not in_phase(stuck.evaluation)
    found = fit_baseline(problem, stiffness_free)
    assert in_phase(found.evaluation) and found.in_phase_until is None
    assert found.model.values[STIFFNESS] == pytest.approx(264e3 * share, rel=0.01)


@pytest.mark.parametrize(("share", "expected"), [(0.31, True), (0.28, False), (1.69, True), (1.72, False)])
def test_a_model_is_in_phase_while_it_leaves_less_than_half_of_the_measured_power(share, expected):
    """A model that moves like the body, but so many times as far, leaves the square of the share that it misses."""
    evaluation = made_up_evaluation((1 - share) * MOTION[None], np.arange(100.0), simulated=share * MOTION)
    np.testing.assert_allclose(evaluation.measured(), MOTION, atol=1e-15)
    assert in_phase(evaluation) == expected


def beam(*effects: str) -> Model:
    """The beam on a coarse mesh."""
    model = load_model("beam").with_numerics(mesh_density=0.5, quadrature_order=2, steps_per_second=120.0)
    return model.with_effects(*effects)


@pytest.fixture(scope="module")
def loaded_and_damped() -> Problem:
    """A swing of a simulated beam with a payload and damping, with a little noise."""
    truth = beam("payload", "material_damping")
    truth = truth.with_values({"payload.mass": 1.7, "material_damping.retardation_time": 0.003})
    noise = 1e-4 * np.random.default_rng(0).standard_normal(len(RUN.time))
    angle = simulate(truth, RUN).sin_theta + noise
    return Problem([Experiment(Recording("let go", RUN.time, angle), RUN)], SerialExecutor())


def test_the_horizons_grow_from_one_swing_to_all_frames(loaded_and_damped):
    """Twice as many swings each time."""
    lengths = [length(horizon) for horizon in horizons(loaded_and_damped)]
    assert 0.1 <= lengths[0] <= 0.25
    assert lengths[-1] == pytest.approx(RUN.time[-1])
    assert all(later > 1.5 * earlier for earlier, later in zip(lengths, lengths[1:], strict=False))


def test_a_mass_is_found_that_nearly_halves_the_frequency(loaded_and_damped):
    """From no mass at all; together with the damping."""
    found = fit_baseline(loaded_and_damped, beam("payload", "material_damping"))
    assert in_phase(found.evaluation)
    assert found.model.values["payload.mass"] == pytest.approx(1.7, rel=0.02)
    assert found.model.values["material_damping.retardation_time"] == pytest.approx(0.003, rel=0.02)


def test_a_model_that_lacks_something_else_is_fitted_as_far_as_it_keeps_phase(loaded_and_damped):
    """Without damping the mass is that of the first swings; where that is not all frames, the result says so."""
    found = fit_baseline(loaded_and_damped, beam("payload"))
    assert found.model.values["payload.mass"] == pytest.approx(1.7, rel=0.1)
    assert in_phase(found.evaluation) or any("in phase with the first" in s for s in found.sentences)
