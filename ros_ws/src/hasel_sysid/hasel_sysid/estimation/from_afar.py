"""A fit from far away: coarse to fine, from the opening of every run to all of its frames."""

from dataclasses import replace

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.draft import draft
from hasel_sysid.estimation.decades import decades
from hasel_sysid.estimation.least_squares import Progress, finished, fit_least_squares, fitted_result
from hasel_sysid.estimation.opening import in_step, openings
from hasel_sysid.estimation.result import FitResult
from hasel_sysid.problem import Problem

_SWEEPS = 2
_BRIEF = 8


def fit_from_afar(problem: Problem, model: Model, progress: Progress | None = None) -> FitResult:
    """Least squares; where that ends out of step with the runs, once more from sizes over the decades of every range.

    A wrong frequency puts a model out of step within a few swings (cycle skipping), so the second fit begins with the
    first swing of every run. Where more frames lose its step again, because something else is missing, the values are
    those of the longest opening that it is in step with, and the result says so.
    Raises SimulationError when neither start can be simulated.
    """
    try:
        near = fit_least_squares(problem, model, progress)
    except SimulationError:
        far = _on_growing_openings(problem, model, progress) if _sizes(model) else None
        if far is None:
            raise
        return far
    if in_step(near.evaluation) or not _sizes(model):
        return finished(problem, near, progress)
    try:
        return _on_growing_openings(problem, model, progress) or near
    except SimulationError:
        return near


def _on_growing_openings(problem: Problem, model: Model, progress: Progress | None) -> FitResult | None:
    """The fit of the longest opening that the model is in step with; None where it is with none."""
    every = openings(problem)
    model, reached = _best_sizes(every[0], model), None
    for number, opening in enumerate(every):
        if progress:
            progress(f"opening {number + 1} of {len(every)}", number / len(every))
        found = fit_least_squares(opening, model, most_evaluations=_BRIEF, drafts=False)
        if not in_step(found.evaluation):
            break
        reached, model = opening, found.model
    if reached is None:
        return None
    if reached is problem:
        return found
    whole = fitted_result(problem.evaluate(model, model.free), found.iterations)
    return replace(whole, in_step_until=max(float(e.run.time[-1] - e.run.start) for e in reached.experiments))


def _best_sizes(problem: Problem, model: Model) -> Model:
    """The model with each size in turn at the one of its decades that fits best, twice round."""
    whole, model = model, draft(model)
    lowest = _squares(problem, [model])[0]
    for _ in range(_SWEEPS):
        before = lowest
        for name in _sizes(model):
            tried = [model.with_values({name: value}) for value in decades(model, name)]
            squares = _squares(problem, tried)
            best = int(np.argmin(squares))
            if squares[best] < lowest:
                model, lowest = tried[best], squares[best]
        if lowest == before:
            break
    return whole.with_values(model.values)


def _squares(problem: Problem, models: list[Model]) -> list[float]:
    found = problem.evaluate_each(models, [()] * len(models))
    return [np.inf if isinstance(one, SimulationError) else one.sum_of_squares for one in found]


def _sizes(model: Model) -> list[str]:
    """Free parameters whose plausible range is known; a muscle's amplitude or slope follows from the first swing."""
    return [name for name in model.free if len(list(decades(model, name)))]
