"""Fits from so far away that the model is out of step within a few swings."""

import numpy as np
import pytest
from hasel_recording import Recording
from hasel_sim.model import load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from hasel_sysid.dataset import Experiment
from hasel_sysid.estimation import fit_baseline, fit_least_squares, in_step
from hasel_sysid.estimation.opening import openings
from hasel_sysid.problem import Problem

RUN = Run("let go", np.arange(0.0, 1.5, 0.01), None, "static_equilibrium", 1.5)


def beam(*effects):
    """The beam on a coarse mesh."""
    model = load_model("beam").with_numerics(mesh_density=0.5, quadrature_order=2, steps_per_second=120.0)
    return model.with_effects(*effects)


def problem(values):
    """A swing of the beam with these effects, with a little noise."""
    truth = beam(*dict.fromkeys(name.partition(".")[0] for name in values)).with_values(values)
    noise = 1e-4 * np.random.default_rng(0).standard_normal(len(RUN.time))
    angle = simulate(truth, RUN).sin_theta + noise
    return Problem([Experiment(Recording("let go", RUN.time, angle), RUN)], SerialExecutor())


def test_the_openings_grow_from_one_swing_to_all_frames():
    """Twice as many swings each time."""
    swinging = problem({"material_damping.retardation_time": 0.003})
    lengths = [len(opening.experiments[0].run.time) for opening in openings(swinging)]
    assert 12 <= lengths[0] <= 20
    assert lengths[-1] == len(RUN.time)
    assert all(later > 1.5 * earlier for earlier, later in zip(lengths, lengths[1:], strict=False))


def test_a_mass_is_found_that_nearly_halves_the_frequency():
    """From no mass at all, where no derivative points home; together with the damping."""
    values = {"payload.mass": 1.7, "material_damping.retardation_time": 0.003}
    swinging, model = problem(values), beam("payload", "material_damping")
    found = fit_baseline(swinging, model)
    assert in_step(found.evaluation)
    for name, value in values.items():
        assert found.model.values[name] == pytest.approx(value, rel=0.02)


def test_a_model_that_lacks_something_else_is_fitted_as_far_as_it_keeps_step():
    """Without damping the mass is that of the first swings, and the result says so."""
    swinging = problem({"payload.mass": 1.7, "material_damping.retardation_time": 0.003})
    found = fit_baseline(swinging, beam("payload"))
    assert found.model.values["payload.mass"] == pytest.approx(1.7, rel=0.1)
    assert any("in step with the first" in sentence for sentence in found.sentences)
    near = fit_least_squares(swinging, beam("payload"))
    assert near.model.values["payload.mass"] < 0.5
