"""From numbers to the verdict on every effect."""

from collections.abc import Mapping
from functools import partial

import numpy as np

from hasel_sysid.diagnosis.context import Context
from hasel_sysid.diagnosis.learned_residual import regressors, unexplained_by
from hasel_sysid.diagnosis.result import Diagnosis, Finding, Verdict
from hasel_sysid.diagnosis.signature import Signature
from hasel_sysid.diagnosis.suspects import numerical_suspects
from hasel_sysid.estimation.refinement import with_numerical_error
from hasel_sysid.policy import POLICY
from hasel_sysid.projection import orthonormal

RULED_OUT = (Verdict.ABSENT, Verdict.INCONCLUSIVE, Verdict.CANNOT_BE_SEEN)
_DETECTION = 3.3
"""Standard errors at which an effect is seen with 95 % certainty at a 5 % false-alarm rate."""


def as_diagnosis(
    context: Context, findings: list[Finding], alike: list[tuple[str, ...]], none: float
) -> Diagnosis:
    """Findings in their order, groups and the probability of none, with what else a context tells."""
    base = context.fit.evaluation
    best = context.winner or min(context.finals, key=context.squares.__getitem__, default=None)
    learned = unexplained_by(np.column_stack([base.jacobian, regressors(base)]), base.residual)
    return Diagnosis(
        findings,
        alike,
        context.noise,
        context.chance,
        0.0 if best is None else context.error_removed(best),
        float(np.clip((context.base - learned @ learned) / context.excess, 0, 1)),
        none,
        numerical_suspects(context.fit, context.changes, context.excess),
        context,
    )


def finding(context: Context, effect) -> Finding:
    """The verdict on one effect, judged beside the winner: what the winner explains accuses nobody else."""
    name = effect.id
    units = {f"{name}.{p.name}": p.unit for p in effect.parameters}
    first = _size(effect)
    whole = partial(
        Finding,
        source=effect.source,
        plausible=(first.lower, first.upper),
        null=first.null,
        winner=None if context.winner == name else context.winner,
    )
    seen = context.signatures.get(name)
    if seen is None:
        verdict = Verdict.NOT_TRIED if name in context.untried else Verdict.INCONCLUSIVE
        return whole(name, verdict, 0.0, 0.0, {}, units, 1.0, float("inf"))
    if name in context.finals:
        model = with_numerical_error(context.finals[name], context.changes).model
        expected = {
            key: (model.values[key], model.parameters[key].standard_error or float("inf")) for key in units
        }
    else:
        residual, left = _beside_winner(context, seen)
        size, error = left.score(residual, context.noise, context.fit.evaluation.runs)
        expected = {next(iter(units)): (seen.null + size * seen.size, abs(error * seen.size))}
    removed = context.removed(name)
    verdict, limit = _verdict(context, effect, seen, removed)
    final = context.finals.get(name)
    said = context.error_removed(name)
    leading = _leading(effect, expected)
    return whole(name, verdict, 0.0, said, expected, units, seen.swallowed, limit, final, leading=leading)


def _size(effect):
    """The parameter that says how large an effect is."""
    return next((p for p in effect.parameters if not p.scan), effect.parameters[0])


def _leading(effect, expected: Mapping[str, tuple[float, float]]) -> str | None:
    """Of an effect's values the one that is furthest from doing nothing, in typical sizes."""
    size = {
        f"{effect.id}.{p.name}": abs(p.typical - p.null)
        for p in effect.parameters
        if not p.scan and p.typical != p.null
    }
    null = {f"{effect.id}.{p.name}": p.null for p in effect.parameters}
    reached = {name: abs(expected[name][0] - null[name]) / size[name] for name in size if name in expected}
    return max(reached, key=reached.get, default=None)


def _beside_winner(context: Context, seen: Signature) -> tuple[np.ndarray, Signature]:
    winner = context.winner
    evaluation = context.fit.evaluation if winner is None else context.finals[winner].evaluation
    basis = orthonormal(evaluation.jacobian)
    left = seen.change - basis @ (basis.T @ seen.change)
    return evaluation.residual, Signature(
        seen.effect, seen.change, left, seen.columns, seen.null, seen.typical
    )


def _verdict(context: Context, effect, seen: Signature, removed: float) -> tuple[Verdict, float]:
    residual, left = _beside_winner(context, seen)
    runs = context.fit.evaluation.runs
    size, error = left.score(residual, context.noise, runs)
    _, alone = seen.score(context.fit.evaluation.residual, context.noise, runs)
    limit = _DETECTION * alone * abs(seen.size)
    if effect.id == context.winner and removed >= POLICY.accused:
        return Verdict.MISSING, limit
    first = _size(effect)
    widest = max(abs(first.lower - first.null), abs(first.upper - first.null))
    if limit > widest or not np.isfinite(limit):
        return Verdict.CANNOT_BE_SEEN, limit
    if effect.id == context.winner or abs(size) > _DETECTION * error:
        return Verdict.MISSING_IF_SIZE_MATTERS, limit
    return (Verdict.ABSENT if limit <= abs(first.typical - first.null) else Verdict.INCONCLUSIVE), limit
