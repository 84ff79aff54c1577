"""Sets of effects that bring a model into step with all frames, found in openings that grow."""

from collections.abc import Callable, Sequence
from functools import partial

from hasel_sim.effects.base import Effect
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.estimation import FitResult, fit_least_squares, in_step
from hasel_sysid.estimation.least_squares import fitted_result
from hasel_sysid.estimation.opening import openings
from hasel_sysid.problem import Problem
from hasel_sysid.selection import FittedSet, Policy, Searched, choose, search
from hasel_sysid.selection.searched import worth_most
from hasel_sysid.selection.sets import EffectSet
from hasel_sysid.selection.simulated_sets import SimulatedSets

_BRIEF = 12
"""Evaluations for a fit to an opening."""

Part = Callable[[str, float, float], Callable[[str, float], None] | None]
"""Who is told of a part's progress: its name, where it begins and ends, 0 to 1."""


def from_afar(
    problem: Problem, fit: FitResult, effects: Sequence[Effect], policy: Policy, part: Part
) -> tuple[FittedSet, ...]:
    """The sets to begin a search with, fitted to all frames; fit: of the model without effects, out of step."""
    rivals: list[Model] = []
    every = openings(problem)
    for number, opening in enumerate(every[:-1]):
        if problem.time_limit.is_over():
            break
        here = _fitted(opening, fit.model)
        sets = SimulatedSets(opening, here, effects, given=fit.model)
        begun = _known(sets, rivals, partial(_in_step, opening))
        reached = begun[0].fit if begun else here
        if in_step(reached.evaluation) or len(sets.known_as(reached).effects) >= policy.most_effects:
            rivals = [one.fit.model for one in begun]
            continue
        report = part(f"opening {number + 1} of {len(every)}", 0.15, 0.25)
        found = search(sets, policy.wider(), report, begun, stand_ins=False)
        rivals = _handed_on(found, choose(found, policy).chosen, policy)
    return _known(SimulatedSets(problem, fit, effects), rivals, partial(_fitted, problem))


def _handed_on(found: Searched, chosen: EffectSet, policy: Policy) -> list[Model]:
    """What longer openings are to judge, for a few frames do not tell how well a set foretells all of them.

    The chosen set and, of every size, those that are worth most: with all frames, the small ones tell what may stand
    in an effect's place, and the large ones where that has led.
    """
    wanted = [chosen]
    lasting = worth_most(found)
    for size in range(1, policy.most_effects + 1):
        wanted += [one for one in lasting if len(one) == size][: policy.effort.fits]
    return [found.known[one].fit.model for one in dict.fromkeys(wanted) if one]


def _known(
    sets: SimulatedSets, models: Sequence[Model], fitted: Callable[[Model], FitResult]
) -> tuple[FittedSet, ...]:
    """Models with effects, as the search sees them; those that cannot be simulated are left out."""
    found = []
    for model in models:
        try:
            found.append(sets.known_as(fitted(model)))
        except SimulationError:
            continue
    return tuple(found)


def _in_step(problem: Problem, model: Model) -> FitResult:
    """A model that moves with the body as it is; another one fitted."""
    as_it_is = fitted_result(problem.evaluate(model, model.free), 1)
    return as_it_is if in_step(as_it_is.evaluation) else _fitted(problem, model)


def _fitted(problem: Problem, model: Model) -> FitResult:
    return fit_least_squares(problem, model, tolerance=1e-3, most_evaluations=_BRIEF, drafts=False)
