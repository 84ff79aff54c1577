# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a search says of every effect, and what it comes to: five verdicts, four statuses."""

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
from hasel_sim.effects.base import EffectParameter

from hasel_sysid.answer.diagnosis import Diagnosis, Finding, Verdict
from hasel_sysid.answer.result import Status
from hasel_sysid.candidates import Candidate
from hasel_sysid.estimation.covariance import with_numerical_error
from hasel_sysid.estimation.fit import FittedModel
from hasel_sysid.estimation.starts import Screened
from hasel_sysid.noise import NoiseModel
from hasel_sysid.policy import POLICY
from hasel_sysid.projection import orthonormal, regressors, unexplained_by
from hasel_sysid.selection.likelihood import NOTHING, Likelihood, Names, Whitened
from hasel_sysid.selection.search import Searched

DETECTION = 3.3
"""Standard errors at which an effect is seen with 95 % certainty at a 5 % false-alarm rate."""
RULED_OUT = (Verdict.ABSENT, Verdict.INCONCLUSIVE, Verdict.CANNOT_BE_SEEN)


def share_left(before: float, after: float, noise: NoiseModel) -> float:
    """Share, 0 to 1, of a mean |Δ sin θ| above the noise that another one leaves.

    Of the mean |Δ sin θ|, not of its square, which would call a law of the wrong shape an explanation.
    """
    floor = noise.mean_absolute
    return float(np.clip((after - floor) / max(before - floor, 1e-12), 0.0, 1.0))


def near_noise(error: float, noise: NoiseModel) -> bool:
    """Whether a mean |Δ sin θ| is as small as a right model may leave, as far as that is known."""
    return error <= POLICY.near_noise * noise.mean_absolute


def status_with(left: float, describes: bool, nothing_else: bool = False) -> Status:
    """The status of effects that leave this share of the mean error above the noise.

    describes: whether the model with them describes its runs to the noise, without which nothing is explained;
    nothing_else: whether what they leave looks like noise.
    """
    if describes and (nothing_else or left <= POLICY.matters):
        return Status.EXPLAINED
    return Status.PARTLY_EXPLAINED if left <= 1 - POLICY.part else Status.UNEXPLAINED


def diagnosis(found: Searched, effects: Sequence[Candidate]) -> Diagnosis:
    """Of the baseline: every effect by the weight of the models that hold it.

    The weights compare listed effects. Where the chosen set leaves more than noise can, what is missing is none of
    them, or not they alone, however much likelier one is than the others.
    """
    noise, choice = found.likelihood.allowed, found.choice
    base = found.models[NOTHING].fitted.fit
    winner = next((next(iter(names)) for names in choice.path if len(names) == 1), None)
    names = {effect.name for effect in effects}
    winner = winner if winner in names else None
    none = _none_of_them(found, noise)
    beside = frozenset({winner}) if winner else NOTHING
    learned = unexplained_by(
        np.column_stack([base.evaluation.jacobian, regressors(base.evaluation)]), base.evaluation.residual
    )
    floor = _expected_squares(base, noise)
    excess = max(base.evaluation.sum_of_squares - floor, 0.05 * floor)
    return Diagnosis(
        findings(found, effects, beside),
        [group for group in choice.groups if names.issuperset(group)],
        noise,
        found.likelihood.noise,
        found.first.chance,
        0.0 if winner is None else _error_removed(found, winner, noise),
        float(np.clip((base.evaluation.sum_of_squares - learned @ learned) / excess, 0, 1)),
        none,
        _numerical_suspects(base, found.discretisation, excess),
        base,
        winner,
    )


def findings(found: Searched, effects: Sequence[Candidate], beside: Names) -> list[Finding]:
    """What is said of every effect, judged beside a fitted set: what that explains accuses nobody else."""
    noise = found.likelihood.allowed
    none = _none_of_them(found, noise)
    said = [_finding(found, effect, beside, noise, none) for effect in effects]
    return sorted(said, key=lambda one: -_order(found, one))


def _none_of_them(found: Searched, noise: NoiseModel) -> float:
    """Probability that what is missing is not listed effects alone."""
    answer = found.answer
    if not answer.candidates or not near_noise(answer.fit.mean_absolute_error, noise):
        return 1.0
    before = found.models[NOTHING].fitted.fit.mean_absolute_error
    return share_left(before, answer.fit.mean_absolute_error, noise)


def _order(found: Searched, one: Finding) -> float:
    """The chosen effects before all others, the first one of the path before the rest; then by weight and error."""
    choice = found.choice
    first = next((names for names in choice.path if names), NOTHING)
    weight = choice.weight_of(one.effect) if choice.chosen else 0.0
    return (
        4.0 * (one.effect in first) + 2.0 * (one.effect in choice.chosen) + weight + 1e-3 * one.error_removed
    )


def _finding(found: Searched, effect: Candidate, beside: Names, noise: NoiseModel, none: float) -> Finding:
    name, first = effect.name, next(iter(effect.sizes.values()))
    of = partial(
        Finding,
        name,
        units={path: p.unit for path, p in zip(effect.names, effect.parameters, strict=True)},
        source=None if effect.effect is None else effect.effect.source,
        plausible=(first.lower, first.upper),
        null=first.null,
        winner=" and ".join(sorted(beside)) if beside and name not in beside else None,
    )
    screened = [one for one in found.screened if one.start.candidate.name == name]
    if not screened:
        verdict = Verdict.NOT_TRIED if name in found.untried else Verdict.INCONCLUSIVE
        return of(verdict, 0.0, 0.0, {}, swallowed=1.0, visible_above=np.inf)
    seen = min(screened, key=lambda one: one.predicted)
    base = found.models[NOTHING].whitened
    step = seen.start.values[effect.path(first)] - first.null
    size, error = _score(found.likelihood, seen, found.models[beside].whitened)
    limit = DETECTION * _score(found.likelihood, seen, base)[1] * abs(step)
    final = found.models.get(frozenset({name}))
    if final is not None:
        expected = _values(effect, final.fitted.fit, found.discretisation)
    else:
        expected = {effect.path(first): (first.null + size * step, abs(error * step))}
    removed = _error_removed(found, name, noise)
    verdict = _verdict(first, name in found.choice.chosen and name in beside, size, error, limit)
    if verdict in RULED_OUT and any(name in group for group in found.choice.groups):
        verdict = Verdict.MISSING_IF_SIZE_MATTERS
    return of(
        verdict,
        (1.0 - none) * found.choice.weight_of(name),
        removed,
        expected,
        swallowed=_imitated(found.models[NOTHING].fitted.fit, seen),
        visible_above=limit,
        fit=None if final is None else final.fitted.fit,
        leading=_leading(effect, expected),
    )


def _score(likelihood: Likelihood, seen: Screened, beside: Whitened) -> tuple[float, float]:
    """Expected size beside a model, as a multiple of the one screened, and its standard error; infinite where nothing
    shows it.
    """
    left = beside.beyond(likelihood.whiten(seen.change))
    power = float(left @ left)
    if power <= 1e-12:
        return 0.0, np.inf
    return float(left @ beside.residual) / power, 1 / float(np.sqrt(power))


def _verdict(first: EffectParameter, chosen: bool, size: float, error: float, limit: float) -> Verdict:
    widest = max(abs(first.lower - first.null), abs(first.upper - first.null))
    if chosen:
        return Verdict.MISSING
    if limit > widest or not np.isfinite(limit):
        return Verdict.CANNOT_BE_SEEN
    if abs(size) > DETECTION * error:
        return Verdict.MISSING_IF_SIZE_MATTERS
    return Verdict.ABSENT if limit <= abs(first.typical - first.null) else Verdict.INCONCLUSIVE


def _values(
    effect: Candidate, fit: FittedModel, changes: Mapping[str, np.ndarray]
) -> dict[str, tuple[float, float]]:
    names = fit.evaluation.names
    covariance = with_numerical_error(fit.evaluation, fit.model.covariance(names), changes)
    model = fit.model.with_covariance(names, covariance)
    return {n: (model.values[n], model.parameters[n].standard_error or np.inf) for n in effect.names}


def _leading(effect: Candidate, expected: Mapping[str, tuple[float, float]]) -> str | None:
    """Of an effect's values the one that is furthest from doing nothing, in typical sizes."""
    reached = {
        name: abs(expected[name][0] - p.null) / abs(p.typical - p.null)
        for name, p in effect.sizes.items()
        if name in expected and p.typical != p.null
    }
    return max(reached, key=reached.__getitem__, default=None)


def _imitated(base: FittedModel, seen: Screened) -> float:
    """Share of what an effect does that the fitted parameters imitate (R of their regression), 0 to 1."""
    basis = orthonormal(base.evaluation.jacobian)
    size = float(np.linalg.norm(seen.change))
    left = seen.change - basis @ (basis.T @ seen.change)
    return 1.0 if size == 0 else float(1 - np.linalg.norm(left) / size)


def _error_removed(found: Searched, name: str, noise: NoiseModel) -> float:
    """Share of the mean error above the noise that an effect removes alone, 0 to 1: as fitted, else as screened.

    Of no error above the noise nobody removes a share.
    """
    base = found.models[NOTHING].fitted.fit
    before = base.mean_absolute_error
    if before <= noise.mean_absolute:
        return 0.0
    if (names := frozenset({name})) in found.models:
        after = found.models[names].fitted.fit.mean_absolute_error
    elif name in found.alone:
        after = found.alone[name].mean_absolute_error
    else:
        squares = min(
            (one.predicted for one in found.screened if one.start.candidate.name == name),
            default=base.evaluation.sum_of_squares,
        )
        after = before * float(np.sqrt(squares / max(base.evaluation.sum_of_squares, 1e-300)))
    return 1.0 - share_left(before, min(after, before), noise)


def _expected_squares(base: FittedModel, noise: NoiseModel) -> float:
    """Expected sum of squares of the noise after the fitted directions and run means are taken out."""
    basis = orthonormal(base.evaluation.jacobian)
    draws = noise.sample(base.evaluation.series, 100, np.random.default_rng(1))
    draws -= basis @ (basis.T @ draws)
    return float((draws**2).sum(axis=0).mean())


def _numerical_suspects(
    base: FittedModel, changes: Mapping[str, np.ndarray], excess: float
) -> dict[str, float]:
    """Share of the excess sum of squares that each refinement explains, the fitted parameters following."""
    residual, basis = base.evaluation.residual, orthonormal(base.evaluation.jacobian)
    shares = {}
    for name, whole in changes.items():
        change = whole - basis @ (basis.T @ whole)
        power = float(change @ change)
        amount = float(np.clip(change @ residual / power, 0.0, 1.0)) if power > 1e-20 else 0.0
        drop = 2 * amount * float(change @ residual) - amount**2 * power
        shares[name] = float(np.clip(drop / excess, 0, 1))
    return shares
