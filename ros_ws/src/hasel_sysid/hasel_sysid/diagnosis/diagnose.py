"""Diagnosis: which effect, if any, explains what a fitted model leaves; no data but the fitted runs are used."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from hasel_sysid.diagnosis.candidates import candidate_effects
from hasel_sysid.diagnosis.context import SIGNIFICANT, Context, expected_squares
from hasel_sysid.diagnosis.finals import full_fits, noise_beyond
from hasel_sysid.diagnosis.groups import groups
from hasel_sysid.diagnosis.judgement import finding
from hasel_sysid.diagnosis.learned_residual import regressors, unexplained_by
from hasel_sysid.diagnosis.probability import probabilities
from hasel_sysid.diagnosis.result import Diagnosis
from hasel_sysid.diagnosis.search import search, search_from_larger
from hasel_sysid.diagnosis.signature import Signature, signature
from hasel_sysid.diagnosis.significance import largest_drops_by_noise, p_value
from hasel_sysid.diagnosis.suspects import numerical_suspects
from hasel_sysid.diagnosis.trial import Trial, Trials
from hasel_sysid.fit import FitResult
from hasel_sysid.fit.refinement import changes_by_refinement
from hasel_sysid.problem import Problem

Progress = Callable[[str, float], None]


def diagnose(
    problem: Problem, fit: FitResult, only: Sequence[str] | None = None, progress: Progress | None = None
) -> Diagnosis:
    """Rank every effect of the catalogue (or the named ones) as an explanation of what `fit` leaves.

    Raises ModelError for an unknown effect.
    """
    effects = candidate_effects(fit.model, tuple(only) if only else None)
    trials = Trials(problem, fit.evaluation)
    best, first = search(trials, effects, progress)
    finals = full_fits(problem, fit, best, lambda: search_from_larger(trials, best, progress), progress)
    signatures = {t.start.effect.id: _signature(t, trials, fit) for t in reversed(first)}

    noise = noise_beyond(fit, finals)
    base = fit.evaluation
    by_noise = largest_drops_by_noise(
        base.jacobian, [s.columns for s in signatures.values()], noise, base.runs
    )
    squares = {t.start.effect.id: min(t.predicted, t.sum_of_squares) for t in best}
    squares.update({effect: final.evaluation.sum_of_squares for effect, final in finals.items()})
    lowest = min([base.sum_of_squares, *(final.evaluation.sum_of_squares for final in finals.values())])
    floor = expected_squares(base.jacobian, noise, base.runs)
    columns = np.column_stack([base.jacobian, regressors(base)])
    learned = unexplained_by(columns, base.residual)
    chance = p_value(base.sum_of_squares - lowest, by_noise)
    changes = changes_by_refinement(problem, base) if chance < SIGNIFICANT else {}
    context = Context(fit, finals, signatures, squares, noise, floor, chance, changes)
    chances, none = probabilities(context)
    findings = [
        replace(finding(context, effect), probability=chances.get(effect.id, 0.0)) for effect in effects
    ]
    findings.sort(key=lambda one: (-one.probability, squares.get(one.effect, np.inf)))
    return Diagnosis(
        findings,
        groups(context),
        noise,
        chance,
        float(np.clip((base.sum_of_squares - lowest) / context.excess, 0, 1)),
        float(np.clip((base.sum_of_squares - learned @ learned) / context.excess, 0, 1)),
        none,
        numerical_suspects(fit, changes, context.excess),
        signatures,
        changes,
    )


def _signature(trial: Trial, trials: Trials, fit: FitResult) -> Signature:
    return signature(trial, fit.evaluation.residual, trials.base.jacobian, trial.start.typical)
