"""The search from far away: which effects bring the model into step, first with one swing, then with all frames."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis, Verdict, diagnose
from hasel_sysid.diagnosis.context import on_own_bound
from hasel_sysid.fit import FitResult, fit_least_squares
from hasel_sysid.fit.opening import in_step, openings
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
    the opening of the runs every effect is still in step: there it is named. The opening then grows for as long as the
    model keeps step, and where it loses it the next effect is looked for. What a model that is in step still lacks is
    left to a search on all frames.
    """
    known = {effect.id for effect in model.effects}
    seen: list[Diagnosis] = []
    every = openings(problem)
    for number, opening in enumerate(every):
        fit = fit_least_squares(opening, model, most_evaluations=12, drafts=False)
        while not in_step(fit.evaluation) and _count(fit, known) < most_effects:
            seen.append(diagnose(opening, fit, only, _part(progress, number, len(every)), decades=True))
            better = _with_best(opening, fit, seen[-1], known)
            if better is None:
                return None
            fit = better
        model = fit.model
    if not seen or not in_step(fit.evaluation):
        return None
    if len(every) > 1:
        swapped = _swapped(every[-2], model, seen, known)
        fit = fit_least_squares(problem, swapped, drafts=False)
    # what finer numerics change was found for the opening's frames only
    first = replace(seen[0], groups=_groups(seen), context=replace(seen[0].context, changes={}))
    return FarStart(first, tuple(_ladder(problem, fit, known)))


def _groups(seen: Sequence[Diagnosis]) -> list[tuple[str, ...]]:
    """What the first diagnosis could not tell apart, and what each later one could not tell from its best effect."""
    later = [
        group for found in seen[1:] if found.best for group in found.groups if found.best.effect in group
    ]
    return list(dict.fromkeys([*seen[0].groups, *later]))


def _with_best(opening: Problem, fit: FitResult, found: Diagnosis, known: set[str]) -> FitResult | None:
    """The fit with the one effect that could be added, less what it makes needless; None where that is a trifle."""
    best = found.best
    if best is None or best.verdict is not Verdict.MISSING or best.fit is None:
        return None
    if 1 - best.fit.evaluation.sum_of_squares / fit.evaluation.sum_of_squares < LEAST_GAIN:
        return None
    earlier = [effect.id for effect in fit.model.effects if effect.id not in known]
    return pruned(opening, best.fit, earlier)


def _swapped(opening: Problem, model: Model, seen: Sequence[Diagnosis], known: set[str]) -> Model:
    """The model, or a better one with one effect after the other in the place of one that looked like it before.

    What one swing cannot tell apart, more of them may.
    """
    fit = fit_least_squares(opening, model, most_evaluations=8, drafts=False)
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
    return fit.model


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
