"""A fit once more from other places of its effects: a tether near the nose looks much like one near the tail."""

from collections.abc import Collection, Iterator, Sequence
from dataclasses import replace
from functools import partial

from hasel_sim.errors import HaselSimError, SimulationError
from hasel_sim.model import Model
from hasel_sim.parallel import all_at_once

from hasel_sysid.diagnosis.candidates import is_place
from hasel_sysid.diagnosis.step import bounded_step
from hasel_sysid.draft import draft
from hasel_sysid.estimation import FitResult, fit_least_squares
from hasel_sysid.problem import Evaluation, Problem

_SHORT = 8
"""Evaluations that the fit of a draft is given."""
_FOLLOWED = 2
"""Places from which drafts are fitted: those from which one step promises most."""
_LOWER = 0.995
"""Share of the squares that a draft must leave at most to be followed: it is not exact elsewhere."""
_SIZES = (1.0, 3.0)
"""As fitted, and larger: what acts where the body moves less must be stronger."""


class Drafts(Problem):
    """A problem of which drafts are simulated, with what they get wrong at one known model taken out.

    Raises SimulationError where the draft of that model cannot be simulated.
    """

    def __init__(self, of: Problem, known: Evaluation) -> None:
        super().__init__(of.experiments, of.pool, of.measured_noise, of.time_limit)
        self._correction = known.residual - of.evaluate(draft(known.model)).residual

    def evaluate_each(
        self, models: Sequence[Model], names: Sequence[Sequence[str]]
    ) -> list[Evaluation | SimulationError]:
        """As of a problem, with the models as they came."""
        found = super().evaluate_each([draft(model) for model in models], names)
        return [
            one
            if isinstance(one, SimulationError)
            else replace(one, model=model, residual=one.residual + self._correction)
            for model, one in zip(models, found, strict=True)
        ]


def deepest(problem: Problem, fit: FitResult, effects: Collection[str], most_evaluations: int) -> FitResult:
    """The fit, or the one in a deeper valley to which drafts lead from the scanned places of these effects of it.

    most_evaluations: of the fit there.
    """
    begins = list(_elsewhere(fit.model, effects))
    if not begins:
        return fit
    try:
        drafts = Drafts(problem, fit.evaluation)
    except SimulationError:
        return fit
    promising = sorted(_promised(drafts, begins), key=lambda pair: pair[0])[:_FOLLOWED]
    fits = [partial(_fitted, drafts, model, 1e-2, _SHORT) for _, model in promising]
    best = min(filter(None, all_at_once(problem.pool, fits)), key=_squares, default=fit)
    if _squares(best) >= _LOWER * _squares(fit):
        return fit
    deeper = _fitted(problem, fit.model.with_values(best.model.values), 1e-3, most_evaluations)
    return min((fit, deeper), key=_squares) if deeper else fit


def _promised(drafts: Drafts, begins: Sequence[Model]) -> list[tuple[float, Model]]:
    """Sum of squares one bounded step on from every model that can be simulated."""
    found = drafts.evaluate_each(begins, [model.free for model in begins])
    return [
        (bounded_step(one.model, one.names, one.residual, one.jacobian)[1], one.model)
        for one in found
        if not isinstance(one, SimulationError)
    ]


def _elsewhere(model: Model, effects: Collection[str]) -> Iterator[Model]:
    """The model with each of these effects in turn at each place of its scan, as large as it is and larger."""
    for effect in model.effects:
        places = [p for p in effect.parameters if is_place(p)] if effect.id in effects else []
        sizes = {f"{effect.id}.{p.name}": p for p in effect.parameters if not p.scan}
        for place in places:
            for factor in _SIZES:
                larger = {
                    name: min(p.null + factor * (model.values[name] - p.null), p.upper)
                    for name, p in sizes.items()
                }
                for value in place.scan:
                    yield model.with_values({**larger, f"{effect.id}.{place.name}": value})


def _fitted(problem: Problem, model: Model, tolerance: float, most: int) -> FitResult | None:
    try:
        return fit_least_squares(
            problem, model, tolerance=tolerance, most_evaluations=most, drafts=False, roughly=True
        )
    except HaselSimError:
        return None


def _squares(fit: FitResult) -> float:
    return fit.evaluation.sum_of_squares
