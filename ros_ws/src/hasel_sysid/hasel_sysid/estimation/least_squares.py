"""Trust-region least squares with exact sensitivities (scipy), the default way to fit."""

from dataclasses import replace

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from scipy.optimize import least_squares

from hasel_sysid.draft import draft
from hasel_sysid.estimation.asked import AskedModel, EnoughError, Progress
from hasel_sysid.estimation.between_runs import wider_where_runs_disagree
from hasel_sysid.estimation.bounds import at_bound
from hasel_sysid.estimation.result import FitResult
from hasel_sysid.estimation.second_start import better_from, onsets_to_doubt, typical_values, unseen_parts
from hasel_sysid.estimation.uncertainty import parameter_covariance
from hasel_sysid.noise import estimate_noise
from hasel_sysid.problem import Evaluation, Problem

_LEAST_SCALE = 1e-3
_GENTLER = 4
"""How often to try a gentler start."""


def fit_least_squares(
    problem: Problem,
    model: Model,
    progress: Progress | None = None,
    tolerance: float = 5e-4,
    most_evaluations: int = 25,
    drafts: bool = True,
    roughly: bool = False,
    goal: float = 0.0,
    begun: Evaluation | None = None,
) -> FitResult:
    """Minimise the squared residuals over the model's free parameters within their bounds.

    A draft of the model (coarse mesh, long steps) leads most of the way, without the onsets that start at none; the
    model itself goes the rest.
    tolerance: ten times the relative change of the sum of squares at which to stop; drafts: whether to start
    with the draft, which is a waste of time when the start is already good; roughly: stop earlier where neighbouring
    frames share what is left, for then so many fewer squares tell models apart; goal: squares that
    the fit must come below at its pace, or it is broken off; `finished` goes on from there; begun: the model by its
    free parameters, if it was evaluated.
    A fit that ends where no derivative leads on is tried once more (`second_start`).
    Raises SimulationError when even the start cannot be simulated.
    """
    if not model.free:
        return fitted_result(problem.evaluate(model), 1)

    def fitted(start: Model, led: bool) -> FitResult:
        count = 0
        if led:
            leader = _without_onsets(draft(start))
            found, count, _ = _minimise(problem, leader, progress, 1e-2, most_evaluations)
            start = start.with_values({name: found.model.values[name] for name in leader.free})
        known = begun if begun and start is model and begun.names == model.free else None
        evaluation, more, ended = _minimise(
            problem, start, progress, tolerance, most_evaluations, roughly, goal, known
        )
        return replace(fitted_result(evaluation, count + more), converged=ended)

    first = fitted(model, drafts)
    doubted = onsets_to_doubt(first)
    return better_from(first, unseen_parts(first) | doubted, lambda start: fitted(start, bool(doubted)))


def finished(problem: Problem, fit: FitResult, progress: Progress | None = None, **options) -> FitResult:
    """The fit, gone on with where it was broken off by its number of evaluations; options: as of a fit."""
    if fit.converged:
        return fit
    return fit_least_squares(problem, fit.model, progress, drafts=False, begun=fit.evaluation, **options)


def _minimise(
    problem: Problem,
    model: Model,
    progress: Progress | None,
    tolerance: float,
    most_evaluations: int,
    roughly: bool = False,
    goal: float = 0.0,
    begun: Evaluation | None = None,
) -> tuple[Evaluation, int, bool]:
    names = model.free
    lower, upper, start = _bounds_and_start(model, names)
    # in units of their scales, for a step that is short beside all values ends the search: beside a value in Pa, any is
    scale = np.maximum(np.abs(start), [_scale(model, name) for name in names])
    rough = 0.1 * tolerance if roughly else 0.0
    search = AskedModel(problem, model, names, scale, progress, most_evaluations, rough, goal)
    try:
        found = least_squares(
            search.residual,
            _first_that_runs(search, start / scale, begun),
            jac=search.jacobian,
            bounds=(lower / scale, upper / scale),
            xtol=0.01 * tolerance,
            ftol=0.1 * tolerance,
            gtol=1e-12,
            max_nfev=most_evaluations,
        )
    except EnoughError as reached:
        return reached.evaluation, search.count, False
    return search.at(found.x), search.count, found.status > 0


def _without_onsets(model: Model) -> Model:
    """Onsets of 0 are left there: beside sizes still far off, a late beginning looks like half of an effect."""
    return model.with_held(*(name for name in model.free if model.is_onset(name) and not model.values[name]))


def _first_that_runs(search: AskedModel, start: np.ndarray, begun: Evaluation | None) -> np.ndarray:
    """The start, its amplitudes halved until the motion is gentle enough to be simulated."""
    amplitudes = np.array([name.startswith("amplitude_") for name in search.names])
    for attempt in range(_GENTLER):
        try:
            search.begin(start, begun)
            return start
        except SimulationError:
            if attempt == _GENTLER - 1 or not amplitudes.any():
                raise
            start = np.where(amplitudes, 0.5 * start, start)
    return start


def _scale(model: Model, name: str) -> float:
    typical = typical_values(model)
    if name in typical:
        return abs(typical[name]) or 1.0
    return model.parameters[name].magnitude or _LEAST_SCALE


def _bounds_and_start(model: Model, names: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    parameters = [model.parameters[name] for name in names]
    lower = np.array([p.lower for p in parameters])
    upper = np.array([p.upper for p in parameters])
    start = np.clip([p.value for p in parameters], lower, upper)
    return lower, upper, start


def fitted_result(evaluation: Evaluation, count: int) -> FitResult:
    """Add standard errors, bounds reached and parameters that are not determined."""
    model, names = evaluation.model, evaluation.names
    noise = estimate_noise(evaluation.residual, evaluation.runs, evaluation.jacobian, "what the fit leaves")
    covariance, undetermined = parameter_covariance(evaluation.jacobian, noise, evaluation.runs)
    by_noise = np.sqrt(np.diag(covariance))
    errors = wider_where_runs_disagree(by_noise, evaluation.jacobian, evaluation.residual, evaluation.runs)
    with np.errstate(invalid="ignore", divide="ignore"):
        wider = np.where(by_noise > 0, errors / by_noise, 1.0)
        covariance = np.where(np.isfinite(covariance), covariance * np.outer(wider, wider), np.inf)
    return FitResult(
        model.with_covariance(names, covariance),
        evaluation,
        at_bound(evaluation),
        tuple(name for name, hidden in zip(names, undetermined, strict=True) if hidden),
        count,
        "least squares",
    )
