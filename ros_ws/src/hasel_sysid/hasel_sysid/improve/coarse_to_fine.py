"""The search from far away: which effects bring the model into step, first with one swing, then with all frames."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis, Verdict, diagnose
from hasel_sysid.fit import FitResult, fit_least_squares
from hasel_sysid.fit.opening import in_step, openings
from hasel_sysid.improve.decision import LEAST_GAIN
from hasel_sysid.improve.neighbours import best_neighbour
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
            if seen and problem.time_limit.is_over():
                return None
            seen.append(diagnose(opening, fit, only, _part(progress, number, len(every)), decades=True))
            better = _better(opening, fit, seen[-1], known, most_effects)
            if better is None:
                return None
            fit = better
        model = fit.model
    if not seen or not in_step(fit.evaluation):
        return None
    # what finer numerics change was found for the opening's frames only
    first = replace(seen[0], groups=_groups(seen), context=replace(seen[0].context, changes={}))
    return FarStart(first, tuple(_ladder(problem, fit, known)))


def _groups(seen: Sequence[Diagnosis]) -> list[tuple[str, ...]]:
    """What the first diagnosis could not tell apart, and what each later one could not tell from its best effect."""
    later = [
        group for found in seen[1:] if found.best for group in found.groups if found.best.effect in group
    ]
    return list(dict.fromkeys([*seen[0].groups, *later]))


def _better(
    opening: Problem, fit: FitResult, found: Diagnosis, known: set[str], most_effects: int
) -> FitResult | None:
    """The fit with one more effect, or of another set where that is not in step; None where nothing comes nearer."""
    best, earlier = found.best, [effect.id for effect in fit.model.effects if effect.id not in known]
    chosen = best.fit if best is not None and best.verdict is Verdict.MISSING else None
    if chosen is None or not in_step(chosen.evaluation):
        chosen = best_neighbour(opening, fit, found, chosen, earlier, most_effects)
    if chosen is None or 1 - chosen.evaluation.sum_of_squares / fit.evaluation.sum_of_squares < LEAST_GAIN:
        return None
    return pruned(opening, chosen, earlier)


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
