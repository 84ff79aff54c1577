# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Gauss-Newton within bounds, against scipy."""

import numpy as np
import pytest
from hasel_sim.model import Model, load_model
from hasel_sysid.estimation.least_squares import (
    GaussNewton,
    at_bound,
    bounded_change,
    further_without_bounds,
    minimise,
    values_and_bounds,
)
from hasel_sysid.problem import Evaluation
from hasel_sysid.testing.made_up_runs import FormulaProblem
from scipy.optimize import least_squares, lsq_linear

JACOBIAN = np.random.default_rng(0).standard_normal((50, 3)) * [1.0, 1e-4, 1e3]
TRUE = np.array([0.5, 200.0, -1e-3])
RETARDATION = "material.soft.retardation_time_s"
UPPER = load_model("arm").parameters[RETARDATION].upper
SERIES = np.sin(np.linspace(0.0, 6.0, 50))
TIME = np.arange(0.0, 2.0, 0.01)
STIFFNESS = "material.soft.youngs_modulus_pa"
MASS, DAMPING = "payload.mass", "material_damping.retardation_time"


def test_without_bounds_a_change_is_least_squares():
    """Whatever the columns' scales."""
    far = np.full(3, np.inf)
    change, squares = bounded_change(JACOBIAN @ TRUE, JACOBIAN, -far, far)
    assert change == pytest.approx(TRUE, rel=1e-6) and squares == pytest.approx(0.0, abs=1e-12)


def test_bounds_hold():
    """And the others make up for it as well as they can."""
    lower, upper = np.array([-0.1, -np.inf, -np.inf]), np.array([0.1, np.inf, np.inf])
    change, squares = bounded_change(JACOBIAN @ TRUE, JACOBIAN, lower, upper)
    rest = np.linalg.lstsq(JACOBIAN[:, 1:], JACOBIAN @ TRUE - 0.1 * JACOBIAN[:, 0], rcond=None)
    assert change[0] == pytest.approx(0.1) and squares == pytest.approx(rest[1][0])


def test_what_nothing_shows_stays():
    """A column of zeros."""
    columns = np.column_stack([np.ones(4), np.zeros(4)])
    change, _ = bounded_change(np.ones(4), columns, np.full(2, -9.0), np.full(2, 9.0))
    assert change[1] == 0.0


@pytest.mark.parametrize("seed", range(20))
def test_many_bounds_are_met_as_an_interior_search_meets_them(seed):
    """Of eight columns that look alike, within bounds that most of them would leave; scipy's reflective search."""
    generator = np.random.default_rng(seed)
    columns = generator.standard_normal((60, 8)) + 3 * generator.standard_normal((60, 1))
    residual, reach = generator.standard_normal(60), 0.03 * generator.random(8)
    _, squares = bounded_change(residual, columns, -reach, reach)
    searched = lsq_linear(columns, residual, (-reach, reach), method="trf", tol=1e-12, max_iter=1000)
    assert squares <= 2 * searched.cost * (1 + 1e-9)


def swing(model: Model, time: np.ndarray) -> np.ndarray:
    """A body that is let go: a heavier one swings more slowly, a softer one too, and a damped one dies away."""
    stiffness, mass, damping = (model.values[name] for name in (STIFFNESS, MASS, DAMPING))
    rate = np.sqrt(stiffness / 264e3 / (1 + mass))
    return 0.2 * np.exp(-20 * damping * rate**2 * time) * np.cos(6 * rate * time)


def body(mass: float, damping: float) -> Model:
    """A beam whose mass and damping are fitted and whose stiffness is free as well, in pascal."""
    model = load_model("beam").with_effects("payload", "material_damping").with_freed(STIFFNESS)
    return model.with_values({MASS: mass, DAMPING: damping})


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("outside", [False, True], ids=["inside", "on a bound"])
def test_it_ends_where_scipy_ends(seed, outside):
    """On a bounded nonlinear problem; in one of two the best damping lies beyond its range."""
    generator = np.random.default_rng(seed)
    truth = body(0.4, 0.02).with_values({STIFFNESS: 264e3 * (1.0 + 0.1 * generator.random())})
    measured = swing(truth, TIME) * (np.exp(0.5 * TIME) if outside else 1.0)
    problem = FormulaProblem(swing, TIME, measured + 0.003 * generator.standard_normal(len(TIME)))
    # mass and stiffness swing alike in this formula: one of them alone is fitted
    start, names = body(0.1, 0.05), (MASS, DAMPING)
    found, converged = minimise(problem, problem.evaluate(start, names), 1e-8, 40)
    value, lower, upper = values_and_bounds(start, names)

    def residual(values: np.ndarray) -> np.ndarray:
        return problem.evaluate(start.with_values(dict(zip(names, values, strict=True)))).residual

    scipys = least_squares(
        residual, value, bounds=(lower, upper), x_scale=[1.0, 0.02], xtol=1e-12, ftol=1e-12
    )
    assert converged
    assert (scipys.x[1] < 1e-5) == outside
    assert found.sum_of_squares <= 2 * scipys.cost * (1 + 1e-5)
    assert found.model.values[MASS] == pytest.approx(scipys.x[0], rel=1e-3)
    assert at_bound(found) == ((DAMPING,) if outside else ())


def test_a_stiffness_in_pascal_does_not_end_the_fit_of_what_is_small_beside_it():
    """Steps of a millisecond are short beside 264 kPa, and yet they are not the end."""
    problem = FormulaProblem(swing, TIME, swing(body(0.0, 0.02), TIME))
    start = problem.evaluate(body(0.0, 0.15).with_values({STIFFNESS: 280e3}), (STIFFNESS, DAMPING))
    found, converged = minimise(problem, start, 1e-6, 40)
    assert converged
    assert found.model.values[DAMPING] == pytest.approx(0.02, rel=1e-3)
    assert found.model.values[STIFFNESS] == pytest.approx(264e3, rel=1e-3)


def test_a_search_that_ran_out_of_evaluations_says_so():
    """It has not converged, and what it has is no worse than where it began."""
    problem = FormulaProblem(swing, TIME, swing(body(0.5, 0.02), TIME))
    start = problem.evaluate(body(0.0, 0.15), (MASS, DAMPING))
    found, converged = minimise(problem, start, 1e-8, 1)
    assert not converged
    assert found.sum_of_squares <= start.sum_of_squares


def test_what_follows_first_moves_alone():
    """Variable projection: in its first step only the named parameters move."""
    problem = FormulaProblem(swing, TIME, swing(body(0.3, 0.02), TIME))
    search = GaussNewton(problem.evaluate(body(0.1, 0.1), (MASS, DAMPING)), 1e-6, (DAMPING,))
    ahead = search.proposal()
    assert ahead.values[MASS] == 0.1 and ahead.values[DAMPING] != 0.1


def test_what_a_search_may_reach_counts_the_parameters_that_follow_later():
    """A start whose first step moves the damping alone is not given up for what the mass will do."""
    problem = FormulaProblem(swing, TIME, swing(body(0.12, 0.1), TIME))
    start = problem.evaluate(body(0.1, 0.1), (MASS, DAMPING))
    both, first = GaussNewton(start, 1e-6), GaussNewton(start, 1e-6, (DAMPING,))
    assert first.predicted == both.predicted < 0.1 * start.sum_of_squares
    assert first.may_reach(0.1 * start.sum_of_squares)


def ended(value: float, pull: float) -> Evaluation:
    """A fit that ended at a value, while the runs ask for so much more of it."""
    model = load_model("arm").with_values({RETARDATION: value})
    runs = np.zeros(len(SERIES), dtype=int)
    return Evaluation(model, (RETARDATION,), (), pull * SERIES, SERIES[:, None], runs, np.zeros(1), ())


@pytest.mark.parametrize(
    ("value", "pull", "held"),
    [
        (UPPER, 0.0, True),
        (0.995 * UPPER, 0.1 * UPPER, True),
        (0.995 * UPPER, -0.1 * UPPER, False),
        (0.995 * UPPER, 0.001 * UPPER, False),
        (0.5 * UPPER, UPPER, False),
    ],
    ids=["on it", "on the way to it", "on the way from it", "near it and at rest", "far from it"],
)
def test_what_is_on_its_way_to_a_bound_is_held_by_it(value, pull, held):
    """Rounding decides how near to a bound a search ends, and not whether the bound holds the parameter."""
    assert at_bound(ended(value, pull)) == ((RETARDATION,) if held else ())


@pytest.mark.parametrize("pull", [-0.1, 0.0, 0.1])
def test_without_its_bounds_a_parameter_goes_where_the_runs_ask_for_it(pull):
    """Beyond them, back into its range, or nowhere."""
    assert further_without_bounds(ended(UPPER, pull * UPPER), RETARDATION) == pytest.approx(pull * UPPER)
