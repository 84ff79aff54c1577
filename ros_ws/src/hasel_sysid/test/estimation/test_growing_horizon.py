# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Fits from so far away that a model is out of phase within a few swings (cycle skipping)."""

import numpy as np
import pytest
from hasel_sim.model import Model, load_model
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.estimation.fit import exact, fitted_model
from hasel_sysid.estimation.growing_horizon import horizons, in_phase, length
from hasel_sysid.testing.made_up_runs import FormulaProblem, made_up_evaluation

TIME = np.arange(0.0, 3.0, 0.01)
STIFFNESS = "material.soft.youngs_modulus_pa"
MASS, DAMPING = "payload.mass", "material_damping.retardation_time"
MOTION = np.sin(np.arange(100.0)) - np.sin(np.arange(100.0)).mean()


def oscillator(model: Model, time: np.ndarray) -> np.ndarray:
    """A body that is let go at 3 Hz for the file's stiffness and without a payload."""
    stiffness = max(model.values.get(STIFFNESS, 264e3), 1.0) / 264e3
    rate = 6 * np.pi * np.sqrt(stiffness / (1 + model.values.get(MASS, 0.0)))
    decay = 0.4 + 100 * model.values.get(DAMPING, 0.0)
    return 0.2 * np.exp(-decay * time) * np.cos(rate * time)


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


def test_the_horizons_grow_from_one_swing_to_all_frames(stiffness_free):
    """Twice as many swings each time."""
    every = horizons(FormulaProblem(oscillator, TIME, oscillator(stiffness_free, TIME)))
    lengths = [length(horizon) for horizon in every]
    assert lengths[0] == pytest.approx(1 / 3, abs=0.02)
    assert lengths[-1] == pytest.approx(TIME[-1])
    assert all(later > 1.5 * earlier for earlier, later in zip(lengths, lengths[1:], strict=False))


def test_an_effect_is_found_that_nearly_halves_the_frequency():
    """A mass, from none at all; together with the damping."""
    model = load_model("beam").with_effects("payload", "material_damping")
    problem = FormulaProblem(
        oscillator, TIME, oscillator(model.with_values({MASS: 1.7, DAMPING: 0.008}), TIME)
    )
    found = fit_baseline(problem, model)
    assert in_phase(found.evaluation)
    assert found.model.values[MASS] == pytest.approx(1.7, rel=0.01)
    assert found.model.values[DAMPING] == pytest.approx(0.008, rel=0.01)


def test_a_model_that_lacks_something_is_fitted_as_far_as_it_keeps_phase(stiffness_free):
    """A body that swings ever more slowly has the stiffness of its first swings, and the fit says how far it goes."""
    rate = 6 * np.pi * np.sqrt(0.5) * TIME * (1 - 0.08 * TIME)
    found = fit_baseline(
        FormulaProblem(oscillator, TIME, 0.2 * np.exp(-0.4 * TIME) * np.cos(rate)), stiffness_free
    )
    assert 0.3 < found.in_phase_until < TIME[-1]
    assert found.model.values[STIFFNESS] == pytest.approx(0.45 * 264e3, rel=0.1)
    assert "in phase with the first" in found.sentences[0]
