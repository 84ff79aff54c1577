"""The best set of effects next to a given one: the promising ones are fitted in full, one score decides."""

from collections.abc import Sequence

from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.context import on_own_bound
from hasel_sysid.diagnosis.explained import EXPLAINED, share_left
from hasel_sysid.diagnosis.left_out import foretells_better
from hasel_sysid.diagnosis.trial import limited
from hasel_sysid.fit import FitResult, fit_least_squares
from hasel_sysid.improve.moves import Move, moves
from hasel_sysid.problem import Problem

_FITTED = 3
"""How many sets are fitted in full."""
_BRIEF = 10
"""Evaluations that each is given."""


def best_neighbour(
    problem: Problem,
    fit: FitResult,
    found: Diagnosis,
    accepted: FitResult | None,
    removable: Sequence[str],
    most_effects: int,
) -> FitResult | None:
    """The fit of the best set of effects that is one move away; None where none is better than the present one.

    accepted: the fit with one effect more that the diagnosis accepts, if it does; removable: effects of the present
    fit that the search has added; most_effects: how many it may add. A set must stay within plausible ranges and
    foretell runs left out better than the present one, and two effects at once must be an explanation: of any two one
    may hope that they imitate a little of anything.
    """
    best = accepted or fit
    sources = {finding.effect: finding.source or finding.effect for finding in found.findings}
    proposed = moves(fit.evaluation, found.context.trials, removable, most_effects - len(removable))
    hopeful = [
        move
        for move in proposed
        if found.context.logarithmic_weight(move.squares, _values_of(move, fit.model)) > _weight(found, best)
    ]
    for move in hopeful[:_FITTED]:
        if problem.time_limit.is_over():
            break
        try:
            model = moved(fit.model, move, sources)
            other = fit_least_squares(problem, model, tolerance=1e-3, most_evaluations=_BRIEF, drafts=False)
        except HaselSimError:
            continue
        if _weight(found, other) > _weight(found, best) and _acceptable(move, other, fit, found):
            best = other
    return None if best is fit else best


def moved(model: Model, move: Move, sources: dict[str, str]) -> Model:
    """The model with the set of effects that a move leads to, at the values where its fit begins.

    Raises ModelError where effects do not go together.
    """
    model = model.without_effects(*move.drop) if move.drop else model
    return model.with_effects(*(sources[effect] for effect in move.add)).with_values(move.values)


def _acceptable(move: Move, other: FitResult, fit: FitResult, found: Diagnosis) -> bool:
    if any(on_own_bound(effect, other) for effect in move.add):
        return False
    if len(move.add) > 1:
        noise = found.noise.mean_absolute
        if share_left(fit.mean_absolute_error, other.mean_absolute_error, noise) > 1 - EXPLAINED:
            return False
    return foretells_better(fit.evaluation, other.evaluation)


def _weight(found: Diagnosis, fit: FitResult) -> float:
    return found.context.logarithmic_weight(fit.evaluation.sum_of_squares, _count(fit.model))


def _count(model: Model) -> int:
    """How many values of effects are free: those that no step is limited in."""
    return sum(not short for short in limited(model, model.free))


def _values_of(move: Move, model: Model) -> int:
    """How many values of effects are free after a move."""
    baseline = len(model.free) - _count(model)
    return len(move.values) - baseline
