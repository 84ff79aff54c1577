"""The search from far away: which effects bring the model into step, first with one swing, then with all frames."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis, Verdict, diagnose
from hasel_sysid.diagnosis.context import on_own_bound
from hasel_sysid.fit import FitResult, fit_least_squares
from hasel_sysid.fit.opening import in_step, openings
from hasel_sysid.improve.conclusion import near_noise
from hasel_sysid.improve.decision import LEAST_GAIN
from hasel_sysid.improve.exchange import with_effect
from hasel_sysid.improve.prune import pruned
from hasel_sysid.problem import Problem

Progress = Callable[[str, float], None]


@dataclass(frozen=True)
class FarStart:
    """first: the diagnosis of the model without effects on the shortest opening that shows something missing; fits: of
    all frames, one for every effect in the order in which they were found.
    """

    first: Diagnosis
    fits: tuple[FitResult, ...]


def far_start(
    problem: Problem,
    model: Model,
    only: Sequence[str] | None,
    most_effects: int,
    progress: Progress | None = None,
) -> FarStart | None:
    """The effects that bring a model into step with all frames; None where none do.

    A wrong frequency puts a model out of step within a few swings, and then whatever damps its motion looks best. In
    the opening of the runs every effect is still in step: there it is named, and more frames only refine it and show
    what else is missing.
    """
    known = {effect.id for effect in model.effects}
    seen: list[Diagnosis] = []
    first, every = None, openings(problem)[:-1]
    for number, opening in enumerate(every):
        part = _part(progress, number, len(every))
        fit = fit_least_squares(opening, model, most_evaluations=12, drafts=False)
        for _ in range(most_effects - _count(fit, known)):
            found = diagnose(opening, fit, only, part, decades=True)
            seen.append(found)
            if first is None and found.best is not None:
                # what finer numerics change was found for the opening's frames only
                first = replace(found, context=replace(found.context, changes={}))
            better = _with_best(opening, fit, found, known)
            if better is None:
                break
            fit = better
            if near_noise(fit, found):
                break
        model = fit.model
    if seen and every:
        model = _swapped(every[-1], fit, seen, known).model
    fit = fit_least_squares(problem, model, drafts=False)
    if first is None or _count(fit, known) == 0 or not in_step(fit.evaluation):
        return None
    return FarStart(first, tuple(_ladder(problem, fit, known)))


def _with_best(opening: Problem, fit: FitResult, found: Diagnosis, known: set[str]) -> FitResult | None:
    """The fit with the one effect that could be added, less what it makes needless; None where that is a trifle."""
    best = found.best
    if best is None or best.verdict is not Verdict.MISSING or best.fit is None:
        return None
    if 1 - best.fit.evaluation.sum_of_squares / fit.evaluation.sum_of_squares < LEAST_GAIN:
        return None
    earlier = [effect.id for effect in fit.model.effects if effect.id not in known]
    return pruned(opening, best.fit, earlier)


def _swapped(opening: Problem, fit: FitResult, seen: Sequence[Diagnosis], known: set[str]) -> FitResult:
    """The fit, or a better one with one effect after the other in the place of one that looked like it before.

    What one swing cannot tell apart, more of them may.
    """
    for effect in [e.id for e in fit.model.effects if e.id not in known]:
        rivals = {r: found for found in seen for g in found.groups if effect in g for r in g}
        for rival in sorted(set(rivals) - {e.id for e in fit.model.effects}):
            try:
                model = with_effect(fit.model.without_effects(effect), rivals[rival], rival)
                other = fit_least_squares(opening, model, most_evaluations=8, drafts=False)
            except HaselSimError:
                continue
            better = other.evaluation.sum_of_squares < fit.evaluation.sum_of_squares
            if better and not on_own_bound(rival, other):
                fit, effect = other, rival
    return fit


def _ladder(problem: Problem, fit: FitResult, known: set[str]) -> list[FitResult]:
    """Fits of all frames with the first effect, the first two, and so on."""
    added = [effect.id for effect in fit.model.effects if effect.id not in known]
    fits = [fit]
    for effect in reversed(added[1:]):
        try:
            fits.insert(0, fit_least_squares(problem, fits[0].model.without_effects(effect), drafts=False))
        except HaselSimError:
            break
    return fits


def _count(fit: FitResult, known: set[str]) -> int:
    return sum(effect.id not in known for effect in fit.model.effects)


def _part(progress: Progress | None, number: int, count: int) -> Progress | None:
    if progress is None:
        return None
    return lambda text, done: progress(f"opening {number + 1} of {count}: {text}", (number + done) / count)
