# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One fit: from each of its starts on the low-fidelity model, then the model itself by manifold mapping.

Manifold mapping: Echeverría and Hemker, Computational Methods in Applied Mathematics 5 (2005) 107.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from hasel_common.progress import Stage
from hasel_sim.effects.base import Effect
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, Parameter

from hasel_sysid.candidates import Candidate
from hasel_sysid.estimation.covariance import (
    changes_by_refinement,
    parameter_covariance,
    wider_where_runs_disagree,
    with_numerical_error,
)
from hasel_sysid.estimation.growing_horizon import horizons, in_phase, length
from hasel_sysid.estimation.least_squares import (
    MOST_STEPS,
    GaussNewton,
    MayWin,
    at_bound,
    bounded_change,
    may_be_least,
    minimise,
    scales,
    step_together,
    values_and_bounds,
)
from hasel_sysid.estimation.starts import MOST_FOLLOWED, screen, starts
from hasel_sysid.expected_work import FIT
from hasel_sysid.experiment import GENTLEST
from hasel_sysid.noise import estimate_noise
from hasel_sysid.problem import Evaluation, LowFidelityProblem, Problem

TOLERANCE = 1e-3
"""Relative change of the sum of squares at which a fit ends."""
_MOST_MAPPED = 3


@dataclass(frozen=True, eq=False)
class FittedModel:
    """The fitted model and how well it is determined.

    model: with fitted values and standard errors; evaluation: at these values; at_bound: parameters on a bound;
    undetermined: parameters that these recordings do not determine; iterations: simulations of all runs;
    in_phase_until: how long after its start [s] the model moves with the body, None for all frames;
    changes_by_refinement: what finer numerics do to the simulated series [frames], as far as that was looked at;
    converged: whether the last step gave next to nothing.
    """

    model: Model
    evaluation: Evaluation
    at_bound: tuple[str, ...]
    undetermined: tuple[str, ...]
    iterations: int = 0
    method: str = "least squares"
    in_phase_until: float | None = None
    changes_by_refinement: Mapping[str, np.ndarray] = field(default_factory=dict)
    converged: bool = True

    @property
    def mean_absolute_error(self) -> float:
        """Mean |Δ sin θ| on the fitted runs."""
        return self.evaluation.mean_absolute_error

    @property
    def sentences(self) -> list[str]:
        """What a user should know about the parameters, one sentence each."""
        notes = []
        if self.in_phase_until is not None:
            notes.append(
                f"The model is in phase with the first {self.in_phase_until:.2g} s of the runs only, to which it was "
                "fitted: something else is missing."
            )
        if not self.converged:
            notes.append(
                f"The fit had not converged after {MOST_STEPS} steps: fit again, beginning with its result."
            )
        notes += [_at_bound(self.model.parameters[name]) for name in self.at_bound]
        notes += [f"{name} cannot be determined from these recordings." for name in self.undetermined]
        return notes

    def __str__(self) -> str:
        values = "; ".join(str(self.model.parameters[name]) for name in self.evaluation.names)
        text = f"Fitted by {self.method} to mean |Δ sin θ| = {self.mean_absolute_error:.5f}: {values}."
        return " ".join([text, *self.sentences])


def _at_bound(p: Parameter) -> str:
    side, bound = (
        ("upper", p.upper) if abs(p.value - p.upper) < abs(p.value - p.lower) else ("lower", p.lower)
    )
    if bound == 0.0:
        return f"{p.name} is at 0: these recordings ask for none of it, or something else is missing."
    unit = "" if p.unit == "1" else f" {p.unit}"
    return f"{p.name} is at its {side} bound, {bound:g}{unit}: something else is missing, or the bound is too tight."


def fitted_model(evaluation: Evaluation, iterations: int = 0) -> FittedModel:
    """An evaluation at fitted values, with standard errors, bounds reached and parameters that are not determined."""
    model, names = evaluation.model, evaluation.names
    noise = estimate_noise(evaluation.residual, evaluation.series, evaluation.jacobian, "what the fit leaves")
    covariance, undetermined = parameter_covariance(evaluation.jacobian, noise, evaluation.series)
    by_noise = np.sqrt(np.diag(covariance))
    errors = wider_where_runs_disagree(by_noise, evaluation.jacobian, evaluation.residual, evaluation.runs)
    with np.errstate(invalid="ignore", divide="ignore"):
        wider = np.where(by_noise > 0, errors / by_noise, 1.0)
        covariance = np.where(np.isfinite(covariance), covariance * np.outer(wider, wider), np.inf)
    return FittedModel(
        model.with_covariance(names, covariance),
        evaluation,
        at_bound(evaluation),
        tuple(name for name, hidden in zip(names, undetermined, strict=True) if hidden),
        iterations,
    )


def refined(problem: Problem, fit: FittedModel) -> FittedModel:
    """The same with standard errors that hold the discretisation error, its refinements simulated now."""
    changes, names = changes_by_refinement(problem, fit.evaluation), fit.evaluation.names
    covariance = with_numerical_error(fit.evaluation, fit.model.covariance(names), changes)
    return replace(fit, model=fit.model.with_covariance(names, covariance), changes_by_refinement=changes)


def descend(
    problem: Problem, models: Sequence[Model], first: Sequence[str] = (), may_win: MayWin = may_be_least
) -> list[Evaluation]:
    """Least squares from each of these models that can be simulated, side by side, as long as it may win; what leaves
    least comes first.

    first: parameters that follow alone in the first step, the others as they begin (variable projection: Golub and
    Pereyra 1973); an onset of 0 moves last of all: beside sizes still far off it looks like half of an effect.
    """
    names = [_without_onsets(model) for model in models]
    begun = [one for one in problem.evaluate_each(models, names) if not isinstance(one, SimulationError)]
    searches = [GaussNewton(one, TOLERANCE, first) for one in begun]
    step_together(problem, searches, may_win)
    found = sorted((search.at for search in searches), key=lambda one: one.sum_of_squares)
    if found and found[0].names != found[0].model.free:
        whole = problem.evaluate_each([found[0].model], [found[0].model.free])[0]
        if not isinstance(whole, SimulationError):
            found[0] = minimise(problem, whole, TOLERANCE, MOST_STEPS)[0]
    return found


def _without_onsets(model: Model) -> tuple[str, ...]:
    return tuple(n for n in model.free if not model.is_onset(n) or model.values[n])


def mapped(problem: Problem, low: Evaluation) -> Evaluation:
    """The model itself from where the low-fidelity model ended, by its derivatives: one to three simulations without
    any of its own. Raises SimulationError where the model cannot be simulated there.
    """
    here, jacobian = problem.evaluate(low.model), low.jacobian
    names, reach = low.names, 0.5 * scales(low.model, low.names)
    for _ in range(_MOST_MAPPED):
        value, lower, upper = values_and_bounds(here.model, names)
        change, left = bounded_change(
            here.residual, jacobian, np.maximum(lower - value, -reach), np.minimum(upper - value, reach)
        )
        if here.sum_of_squares - left <= TOLERANCE * here.sum_of_squares:
            break
        ahead = here.model.with_values(dict(zip(names, value + change, strict=True)))
        (new,) = problem.evaluate_each([ahead], [()])
        if isinstance(new, SimulationError) or new.sum_of_squares >= here.sum_of_squares:
            reach = 0.25 * reach
            continue
        scaled = change / reach
        missed = here.residual - new.residual - jacobian @ change
        jacobian = jacobian + np.outer(missed, scaled / reach) / float(scaled @ scaled)  # Broyden 1965
        here = new
    return replace(here, names=names, jacobian=jacobian)


def exact(problem: Problem, fit: FittedModel, tolerance: float = 0.5 * TOLERANCE) -> FittedModel:
    """A fit gone on with by the model's own derivatives, to its end."""
    evaluation, ended = minimise(problem, problem.evaluate(fit.model, fit.model.free), tolerance, MOST_STEPS)
    found = fitted_model(evaluation, fit.iterations)
    return replace(found, in_phase_until=fit.in_phase_until, converged=ended)


def fit(
    problem: Problem, low: LowFidelityProblem, models: Sequence[Model], first: Sequence[str] = ()
) -> FittedModel:
    """The best fit that begins at any of these models, which have the same parameters.

    low: the problem by the low-fidelity model; first: as of `descend`. Raises SimulationError where none of the models
    can be simulated.
    """
    before = problem.evaluations
    found = descend(low, models, first)
    if not found:
        raise SimulationError("no start of the fit can be simulated: choose other values to begin with")
    return fitted_model(mapped(problem, found[0]), problem.evaluations - before)


def fit_baseline(problem: Problem, model: Model) -> FittedModel:
    """The fit of a model from its standard starts.

    Where that ends out of phase with the runs, once more on growing horizons. Where more frames lose its phase again,
    because something else is missing, the values are those of the longest horizon that it is in phase with, and the
    result says so. Raises SimulationError when no start can be simulated.
    """
    with problem.workload.stage(FIT):
        return _fit_baseline(problem, model)


def _fit_baseline(problem: Problem, model: Model) -> FittedModel:
    if not model.free:
        return fitted_model(problem.evaluate(model), 1)
    failed = None
    try:
        near = fit_from_starts(problem, model)
    except SimulationError as error:
        near, failed = None, error
    if near is not None and in_phase(near.evaluation):
        return near
    far = _on_growing_horizons(problem, model)
    found = far or near
    if found is None:
        raise failed or SimulationError("the model cannot be simulated: choose other values to begin with")
    return found


def _on_growing_horizons(problem: Problem, model: Model) -> FittedModel | None:
    """The fit of the longest horizon that the model is in phase with; None where it is with none."""
    every, reached, found = horizons(problem), None, None
    for number, short in enumerate(every):
        try:
            with short.workload.stage(Stage(f"horizon {number + 1} of {len(every)}")):
                found = fit_from_starts(short, model)
        except SimulationError:
            break
        if not in_phase(found.evaluation):
            break
        reached, model = short, found.model
    if reached is None or reached is problem:
        return found if reached is problem else None
    whole = fitted_model(problem.evaluate(model, model.free))
    return replace(whole, in_phase_until=length(reached))


def fit_from_starts(problem: Problem, model: Model) -> FittedModel:
    """The fit of a model from its own values and, where it has effects, from their standard starts.

    Raises SimulationError when no start can be simulated.
    """
    before, coarse = problem.evaluations, LowFidelityProblem(problem)
    own = {name for effect in model.effects for p in effect.parameters for name in [f"{effect.id}.{p.name}"]}
    with problem.workload.stage(Stage("low-fidelity model")):
        begin = [_that_runs(coarse, model)]
        for effect in model.effects:
            begin += _standard_starts(coarse, begin[0], effect)
        led = descend(coarse, begin, [name for name in model.free if name not in own])
    with problem.workload.stage(Stage("the model itself")):
        start = problem.evaluate(led[0].model if led else begin[0], model.free)
        evaluation, ended = minimise(problem, start, 0.5 * TOLERANCE, MOST_STEPS)
    return replace(fitted_model(evaluation, problem.evaluations - before), converged=ended)


def _that_runs(problem: Problem, model: Model) -> Model:
    """The model, its amplitudes halved until the motion is gentle enough to be simulated."""
    gentle, share = model, 1.0
    while True:
        (seen,) = problem.evaluate_each([gentle], [()])
        if not isinstance(seen, SimulationError):
            return gentle
        if share <= GENTLEST or not any(map(model.is_amplitude, model.values)):
            raise seen
        share *= 0.5
        gentle = model.with_amplitudes_times(share)


def _standard_starts(problem: Problem, model: Model, effect: Effect) -> list[Model]:
    """The model with an effect at the most promising of its starts, all else fitted without it."""
    candidate = Candidate(effect.id, effect.parameters, effect)
    free = {name for name in candidate.names if model.parameters[name].free}
    if not free & set(candidate.sizes):
        return []
    bare = descend(problem, [model.without_effects(effect.id)])
    if not bare:
        return []
    promising = sorted(screen(problem, bare[0], starts(candidate)), key=lambda one: one.predicted)
    return [
        model.with_values({**bare[0].model.values, **{n: v for n, v in one.values().items() if n in free}})
        for one in promising[:MOST_FOLLOWED]
    ]
