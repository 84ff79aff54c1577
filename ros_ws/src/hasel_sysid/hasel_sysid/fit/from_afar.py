"""A fit from far away: coarse to fine, from the opening of every run to all of its frames."""

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.draft import draft
from hasel_sysid.fit.decades import decades
from hasel_sysid.fit.least_squares import Progress, fit_least_squares
from hasel_sysid.fit.opening import in_step, openings
from hasel_sysid.fit.result import FitResult
from hasel_sysid.problem import Problem

_SWEEPS = 2
_BRIEF = 8


def fit_from_afar(problem: Problem, model: Model, progress: Progress | None = None) -> FitResult:
    """Least squares; where that ends out of step with the runs, once more from sizes over the decades of every range.

    A wrong frequency puts a model out of step within a few swings (cycle skipping), so the second fit begins with the
    first swing of every run. Raises SimulationError when neither start can be simulated.
    """
    try:
        near = fit_least_squares(problem, model, progress)
    except SimulationError:
        if not _sizes(model):
            raise
        return _on_growing_openings(problem, model, progress)
    if in_step(near.evaluation) or not _sizes(model):
        return near
    try:
        far = _on_growing_openings(problem, model, progress)
    except SimulationError:
        return near
    return min(near, far, key=lambda fit: fit.evaluation.sum_of_squares)


def _on_growing_openings(problem: Problem, model: Model, progress: Progress | None) -> FitResult:
    every = openings(problem)
    model = _best_sizes(every[0], model)
    for number, opening in enumerate(every[:-1]):
        if progress:
            progress(f"opening {number + 1} of {len(every)}", number / len(every))
        found = fit_least_squares(opening, draft(model), most_evaluations=_BRIEF, drafts=False)
        model = model.with_values({name: found.model.values[name] for name in model.free})
    return fit_least_squares(problem, model, progress, drafts=False)


def _best_sizes(problem: Problem, model: Model) -> Model:
    """The model with each size in turn at the one of its decades that fits best, twice round."""
    model = draft(model)
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
    return model


def _squares(problem: Problem, models: list[Model]) -> list[float]:
    found = problem.evaluate_each(models, [()] * len(models))
    return [np.inf if isinstance(one, SimulationError) else one.sum_of_squares for one in found]


def _sizes(model: Model) -> list[str]:
    """Free parameters whose plausible range is known; a muscle's amplitude or slope follows from the first swing."""
    return [name for name in model.free if len(list(decades(model, name)))]
