"""What a search among sets says of every effect, in the terms that report, node and commands know."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from hasel_sysid.diagnosis import Diagnosis, Finding, Verdict
from hasel_sysid.diagnosis.adequacy import adequacy
from hasel_sysid.diagnosis.context import Context, expected_squares
from hasel_sysid.diagnosis.explained import near_noise, share_left
from hasel_sysid.diagnosis.judgement import RULED_OUT, as_diagnosis, finding
from hasel_sysid.diagnosis.reached import squares_reached
from hasel_sysid.diagnosis.signature import signature
from hasel_sysid.estimation import FitResult
from hasel_sysid.noise import NoiseModel, allowed_noise
from hasel_sysid.policy import POLICY
from hasel_sysid.selection.choice import Choice
from hasel_sysid.selection.searched import Searched
from hasel_sysid.selection.sets import NOTHING, EffectSet
from hasel_sysid.selection.simulated_sets import SimulatedSets


def diagnosis(
    sets: SimulatedSets, found: Searched, choice: Choice, changes: Mapping[str, np.ndarray]
) -> Diagnosis:
    """Of the baseline: every effect by the weight of the sets that hold it; changes: by finer numerics [frames].

    The weights compare listed effects. Where the chosen set leaves more than noise can, what is missing is none of
    them, or not they alone, however much likelier one is than the others.
    """
    context = _context(sets, found, choice, changes)
    none = _none_of_them(found, choice, context.noise)
    groups = list(choice.groups)
    findings = [
        replace(finding(context, effect), probability=(1.0 - none) * choice.weight_of(effect.id))
        for effect in context.effects
    ]
    findings = [_one_answer(one, choice, groups) for one in findings]
    findings.sort(key=lambda one: (-_order(one, choice), context.squares.get(one.effect, np.inf)))
    return as_diagnosis(context, findings, groups, none)


def _none_of_them(found: Searched, choice: Choice, noise: NoiseModel) -> float:
    """Probability that what is missing is not listed effects alone."""
    if not choice.chosen or not near_noise(found.known[choice.chosen].fit.mean_absolute_error, noise):
        return 1.0
    return share_left_by(found, choice.chosen, noise)


def _context(
    sets: SimulatedSets, found: Searched, choice: Choice, changes: Mapping[str, np.ndarray]
) -> Context:
    fit = sets.fitted
    finals = {next(iter(s)): f.fit for s, f in found.known.items() if len(s) == 1}
    of_effect = {effect: prospect.start for effect, prospect in found.prospects.items()}
    squares = squares_reached(list(of_effect.values()), finals, fit.evaluation.sum_of_squares, hurried=False)
    signatures = {
        t.start.effect.id: signature(t, fit.evaluation.residual, sets.trials.base.jacobian, t.start.typical)
        for t in reversed(sets.first)
    }
    measured, noise = found.likelihood.noise, noise_allowed(sets, found)
    named = next((next(iter(s)) for s in choice.path if len(s) == 1), None)
    return Context(
        list(sets.effects.values()),
        fit,
        finals,
        signatures,
        squares,
        noise,
        expected_squares(fit.evaluation.jacobian, noise, fit.evaluation.runs),
        found.first.chance,
        dict(changes),
        measured,
        of_effect,
        frozenset(sets.effects) - sets.tried,
        winner=named,
    )


def noise_allowed(sets: SimulatedSets, found: Searched) -> NoiseModel:
    """By which a model is judged: what was measured, and what no model has."""
    return allowed_noise(found.likelihood.noise, POLICY.discrepancy * sets.swing)


def describes(sets: SimulatedSets, found: Searched, fit: FitResult) -> bool:
    """Whether a fit describes its runs everywhere, by that noise."""
    return adequacy(fit.evaluation, noise_allowed(sets, found)).adequate


def share_left_by(found: Searched, effects: EffectSet, noise: NoiseModel) -> float:
    """Share of the baseline's mean error above the noise that a known set leaves."""
    before, after = (found.known[s].fit.mean_absolute_error for s in (NOTHING, effects))
    return share_left(before, after, noise.mean_absolute)


def _order(one: Finding, choice: Choice) -> float:
    """The chosen effects before all others, the first one of the path before the rest."""
    first = next((s for s in choice.path if s), NOTHING)
    return (
        (2.0 if one.effect in first else 0.0)
        + (1.0 if one.effect in choice.chosen else 0.0)
        + (choice.weight_of(one.effect) if choice.chosen else 0.0)
    )


def _one_answer(one: Finding, choice: Choice, groups: Sequence[tuple[str, ...]]) -> Finding:
    """What cannot be told from a chosen effect is not called absent: it could stand in its place."""
    in_doubt = any(one.effect in group for group in groups) and one.effect not in choice.chosen
    if in_doubt and one.verdict in RULED_OUT:
        return replace(one, verdict=Verdict.MISSING_IF_SIZE_MATTERS)
    return one
