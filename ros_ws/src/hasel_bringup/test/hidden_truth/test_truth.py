# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import numpy as np
import pytest
from hasel_bringup.hidden_truth.plan import FITTED
from hasel_bringup.hidden_truth.truth import NOMINAL, NUMERICS, draw_muscles, draw_secret, truth_model
from hasel_sim.drive.amplitudes import target_contraction
from hasel_sim.model import load_model
from hasel_sim.model_mesh import model_mesh
from hasel_sim.simulate import simulate


@pytest.mark.parametrize("numerics", NUMERICS.values(), ids=lambda n: n.name)
def test_is_not_the_model(numerics):
    """Mesh and time step differ, and no node of the body's inside but the regions' corners is shared by design."""
    truth, model = truth_model(numerics, NOMINAL), load_model("swimmer")
    assert len(model_mesh(truth).nodes) % len(model_mesh(model).nodes) != 0
    assert truth.description.numerics.steps_per_second >= 4 * model.description.numerics.steps_per_second


def test_muscle_law_is_smooth_and_not_the_models_interpolation():
    """Between the fitted voltages the truth follows its own rising curve, which the model's interpolation misses."""
    truth = truth_model(NUMERICS["near"], NOMINAL)
    voltage = np.linspace(100.0, 5900.0, 400)
    levels = truth.levels
    found = target_contraction(voltage, levels, np.array([truth.values[f"amplitude_{v:g}"] for v in levels]))
    np.testing.assert_allclose(found, NOMINAL.contraction(voltage), atol=2e-5)
    assert np.all(np.diff(found) > 0)
    known = np.array([3500.0, 4500.0, 5500.0])
    models = target_contraction(voltage, known, NOMINAL.contraction(known))
    assert np.abs(models - found).max() > 1e-4


def test_draws_lie_around_the_nominal_muscles():
    """Stroke at 4.5 kV and slope lie within 15 % of nominal, and are spread over that range."""
    drawn = [draw_muscles(np.random.default_rng(seed)) for seed in range(200)]
    stroke = np.array([m.contraction(np.array([4500.0]))[0] for m in drawn]) / 0.044
    slope = np.array([m.slope for m in drawn]) / NOMINAL.slope
    for ratio in (stroke, slope):
        assert 0.84 < ratio.min() < 0.88
        assert 1.12 < ratio.max() < 1.16


def test_bends_like_the_model():
    """With the same muscles, the near truth and the model differ by less than the noise, but differ."""
    run = FITTED[2].run()
    truth = truth_model(NUMERICS["near"], NOMINAL)
    model = load_model("swimmer").with_levels(truth.levels).with_values(truth.values)
    difference = simulate(truth, run).sin_theta - simulate(model, run).sin_theta
    assert 1e-5 < np.sqrt(np.mean(difference**2)) < 0.003


@pytest.mark.parametrize(
    ("hidden", "said"),
    [
        (["quadratic_drag.coefficient=0.25"], "quadratic_drag.coefficient = 0.25"),
        (
            ["charging_lag.charge_time=0.07", "slope=0.4"],
            "charging_lag.charge_time = 0.07 s, slope = 0.4 1/s",
        ),
        (["none"], "none"),
    ],
)
def test_a_secret_is_told_with_units_where_there_are_any(hidden, said):
    """A ratio has none."""
    assert str(draw_secret(hidden, np.random.default_rng(0))) == said
