# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One fit: multi-start on the low-fidelity model, manifold mapping, and what is said of its parameters."""

import numpy as np
import pytest
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, load_model, save_model
from hasel_sysid.estimation import FittedModel, fit_baseline
from hasel_sysid.estimation.fit import descend, exact, fit, fitted_model, mapped
from hasel_sysid.estimation.least_squares import GaussNewton, best_of_each, minimise
from hasel_sysid.noise import NoiseModel
from hasel_sysid.problem import Evaluation, LowFidelityProblem, low_fidelity
from hasel_sysid.selection.likelihood import Likelihood
from hasel_sysid.testing.made_up_runs import FormulaProblem, made_up_evaluation
from hasel_sysid.testing.made_up_world import NOISE, MadeUpWorld

TIME = np.arange(0.0, 2.0, 0.01)
MASS, DAMPING = "payload.mass", "material_damping.retardation_time"
STEPS = load_model("beam").description.numerics.steps_per_second


def swing(model: Model, time: np.ndarray) -> np.ndarray:
    """A body that is let go; coarse steps make it swing by 2 % more slowly, and damp it."""
    coarse = model.description.numerics.steps_per_second < STEPS
    rate = (0.98 if coarse else 1.0) * 6 / np.sqrt(1 + model.values[MASS])
    decay = 20 * model.values[DAMPING] + (0.06 if coarse else 0.0)
    return 0.2 * np.exp(-decay * time) * np.cos(rate * time)


def body(mass: float, damping: float) -> Model:
    """A beam whose mass and damping are fitted."""
    return (
        load_model("beam")
        .with_effects("payload", "material_damping")
        .with_values({MASS: mass, DAMPING: damping})
    )


@pytest.fixture
def problem() -> FormulaProblem:
    """A swing with noise."""
    noise = 0.001 * np.random.default_rng(0).standard_normal(len(TIME))
    return FormulaProblem(swing, TIME, swing(body(0.3, 0.03), TIME) + noise)


def test_manifold_mapping_ends_at_the_exact_optimum(problem):
    """Though the derivatives, and the low-fidelity optimum it begins at, are those of a cruder model."""
    best = exact(problem, fitted_model(problem.evaluate(body(0.3, 0.03), (MASS, DAMPING))), 1e-8).evaluation
    crude, _ = minimise(
        LowFidelity(problem), LowFidelity(problem).evaluate(body(0.2, 0.02), (MASS, DAMPING)), 1e-8, 40
    )
    assert problem.evaluate(crude.model).sum_of_squares > 5 * best.sum_of_squares
    found = mapped(problem, crude)
    assert found.sum_of_squares == pytest.approx(best.sum_of_squares, rel=2e-3)
    errors = fitted_model(best).model.parameters
    for name in (MASS, DAMPING):
        assert abs(found.model.values[name] - best.model.values[name]) < 0.1 * errors[name].standard_error


def test_each_of_the_best_so_many_is_followed_to_its_end(problem):
    """The one that can no longer become the best is left where it is, unless the second best is asked for, too; of two
    starts for the same parameters, the one that promises more goes on.
    """
    right = body(0.3, 0.02).with_held(MASS)
    wrong, further = body(0.6, 0.1).with_held(DAMPING), body(0.9, 0.1).with_held(DAMPING)
    best, second = descend(problem, [wrong, right])
    assert (best.names, second.names) == ((DAMPING,), (MASS,))
    ended, converged = minimise(problem, problem.evaluate(wrong, (MASS,)), 1e-3, 10)
    assert converged and second.sum_of_squares > 1.02 * ended.sum_of_squares
    _, followed = descend(problem, [wrong, right], may_win=best_of_each(2))
    assert followed.sum_of_squares == pytest.approx(ended.sum_of_squares, rel=1e-3)
    searches = [GaussNewton(problem.evaluate(one, one.free), 1e-3) for one in (further, wrong, right)]
    going = [search.names for search, goes in zip(searches, best_of_each(2)(searches), strict=True) if goes]
    assert sorted(going) == [(DAMPING,), (MASS,)]


class LowFidelity(FormulaProblem):
    """The same runs by the low-fidelity model alone."""

    def __init__(self, of: FormulaProblem) -> None:
        super().__init__(
            lambda model, time: swing(low_fidelity(model), time), TIME, of.experiments[0].sin_theta
        )


def test_of_several_starts_the_best_end_is_taken():
    """Multi-start: beside a start that ends in another valley, wherever it stands in the list."""
    time = np.arange(0.0, 6.0, 0.01)
    noise = 0.001 * np.random.default_rng(0).standard_normal(len(time))
    problem = FormulaProblem(swing, time, swing(body(0.3, 0.005), time) + noise)
    low = LowFidelityProblem(problem, problem.evaluate(body(0.3, 0.005), (MASS, DAMPING)))
    lost, near = body(9.0, 0.005), body(0.25, 0.005)
    alone = fit(problem, low, [near])
    assert alone.model.values[MASS] == pytest.approx(0.3, rel=0.01)
    assert fit(problem, low, [lost]).evaluation.sum_of_squares > 10 * alone.evaluation.sum_of_squares
    for models in ([lost, near], [near, lost]):
        both = fit(problem, low, models)
        assert both.evaluation.sum_of_squares == pytest.approx(alone.evaluation.sum_of_squares, rel=1e-3)


class Fragile(FormulaProblem):
    """What is heavier than twice the body cannot be simulated."""

    def evaluate_each(self, models, names):
        """Of the others as of a problem."""
        found = super().evaluate_each(models, names)
        return [
            SimulationError("not finite") if m.values[MASS] > 2 else one
            for m, one in zip(models, found, strict=True)
        ]


def test_a_start_that_cannot_be_simulated_is_left_out(problem):
    """The others are followed; where none can be, that is an error in one sentence."""
    fragile = Fragile(swing, TIME, problem.experiments[0].sin_theta)
    low = LowFidelityProblem(fragile, fragile.evaluate(body(0.3, 0.03), (MASS, DAMPING)))
    found = fit(fragile, low, [body(5.0, 0.03), body(0.25, 0.03)])
    assert found.model.values[MASS] == pytest.approx(0.3, rel=0.02)
    with pytest.raises(SimulationError, match="no start of the fit can be simulated"):
        fit(fragile, low, [body(5.0, 0.03)])


@pytest.mark.parametrize("hidden", ["payload", "viscoelastic_creep", "charge_retention", "tether"])
def test_a_fit_from_standard_starts_ends_as_likely_as_one_from_the_truth(hidden):
    """Of a size, a time and a place that are no starts."""
    world = MadeUpWorld(2)
    truth = world.with_typical(hidden)
    (effect,) = truth.effects
    moved = {f"{hidden}.{p.name}": 1.7 if not p.scan else 1.3 for p in effect.parameters}
    truth = truth.with_values({name: factor * truth.values[name] for name, factor in moved.items()})
    measured = world.measured(truth)
    found = fit_baseline(measured, world.model.with_effects(hidden)).evaluation
    best = exact(measured, fitted_model(measured.evaluate(truth, truth.free)), 1e-8).evaluation
    likelihood = Likelihood(NoiseModel(NOISE**2, 0.0, 0.5), found.runs)
    ours, theirs = (likelihood.of(one.residual, one.jacobian).logarithm for one in (found, best))
    assert ours == pytest.approx(theirs, abs=0.5)


def evaluated(jacobian: np.ndarray) -> Evaluation:
    """Two parameters of a swimmer with these derivatives, in white noise of 0.003."""
    model = load_model("swimmer").with_levels([4500.0])
    residual = 0.003 * np.random.default_rng(0).normal(size=len(jacobian))
    names, time = ("slope", "amplitude_4500"), np.arange(len(jacobian)) / 120
    return made_up_evaluation(residual[None], time, None, None, jacobian, names, model)


def test_the_covariance_of_a_fit_goes_with_its_model(tmp_path):
    """Two parameters that do nearly the same: their errors have a correlation near -1, in the model and in its file."""
    one, other = np.random.default_rng(2).normal(size=(2, 2000))
    jacobian = np.column_stack([one, one + 0.1 * other])
    evaluation = evaluated(jacobian)
    names, found = evaluation.names, fitted_model(evaluation).model
    expected = 0.003**2 * np.linalg.inv(jacobian.T @ jacobian)
    assert found.covariance(names) == pytest.approx(expected, rel=0.2)
    save_model(found, tmp_path / "fitted.yaml")
    again = load_model(tmp_path / "fitted.yaml").covariance(names)
    assert again == pytest.approx(found.covariance(names))
    assert again[0, 1] < -0.98 * np.sqrt(np.prod(np.diag(again)))


def test_a_parameter_that_is_no_longer_determined_keeps_no_standard_error():
    """An earlier fit's error says nothing of a value that these recordings do not show."""
    result = fitted_model(evaluated(np.column_stack([np.ones(100), np.zeros(100)])))
    assert result.undetermined == ("amplitude_4500",)
    assert result.model.parameters["amplitude_4500"].standard_error is None
    assert result.model.parameters["slope"].standard_error is not None
    assert result.sentences == ["amplitude_4500 cannot be determined from these recordings."]


@pytest.mark.parametrize(
    ("value", "sentence"),
    [
        (
            0.0,
            "quadratic_drag.coefficient is at 0: these recordings ask for none of it, or something else is missing.",
        ),
        (
            10.0,
            "quadratic_drag.coefficient is at its upper bound, 10: something else is missing, or the bound is too "
            "tight.",
        ),
    ],
)
def test_a_value_on_a_bound_is_said(value, sentence):
    """With the bound; that nothing is asked for is no bound that is too tight."""
    model = (
        load_model("swimmer")
        .with_effects("quadratic_drag")
        .with_values({"quadratic_drag.coefficient": value})
    )
    names = ("quadratic_drag.coefficient",)
    nothing = np.zeros(0)
    evaluation = Evaluation(model, names, (), nothing, np.zeros((0, 1)), nothing, nothing, ())
    assert FittedModel(model, evaluation, names, (), 1, "least squares").sentences == [sentence]


def test_a_fit_that_has_not_converged_says_so(problem):
    """A tolerance that no step reaches; the same fit with the usual one has nothing to say."""
    begun = fitted_model(problem.evaluate(body(0.25, 0.025), (MASS, DAMPING)))
    short = exact(problem, begun, tolerance=-1.0)
    assert not short.converged and "had not converged after 10 steps" in str(short)
    ended = exact(problem, begun)
    assert ended.converged and "converged" not in str(ended)
