"""Diagnosis: which effect, if any, explains what a fitted model leaves; no data but the fitted runs are used."""

from collections.abc import Callable, Sequence
from dataclasses import replace

from hasel_sysid.diagnosis.adequacy import adequacy
from hasel_sysid.diagnosis.candidates import candidate_effects
from hasel_sysid.diagnosis.context import SIGNIFICANT, Context, expected_squares, lowest_squares
from hasel_sysid.diagnosis.finals import allowed_noise, full_fits, noise_of
from hasel_sysid.diagnosis.judgement import judged
from hasel_sysid.diagnosis.reached import squares_reached
from hasel_sysid.diagnosis.result import Diagnosis, Verdict
from hasel_sysid.diagnosis.search import search, search_from_larger
from hasel_sysid.diagnosis.signature import Signature, signature
from hasel_sysid.diagnosis.significance import largest_drops_by_noise, p_value
from hasel_sysid.diagnosis.trial import Trial, Trials
from hasel_sysid.fit import FitResult
from hasel_sysid.fit.refinement import changes_by_refinement
from hasel_sysid.problem import Problem

Progress = Callable[[str, float], None]


def diagnose(
    problem: Problem,
    fit: FitResult,
    only: Sequence[str] | None = None,
    progress: Progress | None = None,
    decades: bool = False,
) -> Diagnosis:
    """Rank every effect of the catalogue (or the named ones) as an explanation of what `fit` leaves.

    decades: start every effect from sizes over all decades of its range, where the model may be far off.
    Raises ModelError for an unknown effect.
    """
    effects = candidate_effects(fit.model, tuple(only) if only else None)
    trials = Trials(problem, fit.evaluation)
    best, first = search(trials, effects, progress, decades)
    finals = full_fits(
        problem, fit, best, lambda worth: search_from_larger(trials, best, worth, progress), progress
    )
    signatures = {t.start.effect.id: _signature(t, trials, fit) for t in reversed(first)}

    measured = noise_of(problem, fit, finals)
    noise = allowed_noise(problem, measured)
    base = fit.evaluation
    by_noise = largest_drops_by_noise(
        base.jacobian, [s.columns for s in signatures.values()], noise, base.runs
    )
    hurried = problem.time_limit.left_something_out
    squares = squares_reached(best, finals, base.sum_of_squares, hurried)
    floor = expected_squares(base.jacobian, noise, base.runs)
    chance = p_value(base.sum_of_squares - lowest_squares(fit, finals), by_noise)
    changes = changes_by_refinement(problem, base) if chance < SIGNIFICANT else {}
    of_effect = {t.start.effect.id: t for t in best}
    found = judged(
        Context(
            effects,
            fit,
            finals,
            signatures,
            squares,
            noise,
            floor,
            chance,
            changes,
            measured,
            of_effect,
            frozenset(effect.id for effect in effects) - trials.tried,
        )
    )
    named = found.best is not None and found.best.verdict is Verdict.MISSING
    described = adequacy((found.best.fit if named else fit).evaluation, noise)
    return replace(found.seen_beside(described.adequate), adequacy=described)


def _signature(trial: Trial, trials: Trials, fit: FitResult) -> Signature:
    return signature(trial, fit.evaluation.residual, trials.base.jacobian, trial.start.typical)
