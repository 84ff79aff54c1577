"""From numbers to verdicts, probabilities and groups."""

from dataclasses import dataclass

import numpy as np

from hasel_sysid.diagnosis.result import Finding, Verdict
from hasel_sysid.diagnosis.signature import Signature, alike
from hasel_sysid.diagnosis.significance import orthonormal
from hasel_sysid.fit.refinement import with_numerical_error
from hasel_sysid.fit.result import FitResult
from hasel_sysid.noise import NoiseModel

SIGNIFICANT = 0.01
"""Chance that noise alone looks like this below which something is missing."""
_MATTERS = 0.4
"""An effect that removes less than this share of the error above the noise is not what is missing."""
_ALIKE = 0.95
_LEAST_EXCESS = 0.05
_DETECTION = 3.3
"""Standard errors at which an effect is seen with 95 % certainty at a 5 % false-alarm rate."""
_TOLD_APART = 0.03
"""Two effects whose refits differ by less than this share of the excess are not told apart: no model is that exact."""


@dataclass(frozen=True)
class Context:
    """Everything a verdict rests on.

    squares: sum of squared residuals reached with each effect; changes: of the simulated series by finer numerics.
    """

    fit: FitResult
    finals: dict[str, FitResult]
    signatures: dict[str, Signature]
    squares: dict[str, float]
    noise: NoiseModel
    floor: float
    chance: float
    changes: dict[str, np.ndarray]

    @property
    def base(self) -> float:
        """Sum of squares without any effect."""
        return self.fit.evaluation.sum_of_squares

    @property
    def excess(self) -> float:
        """Sum of squares above the noise; never less than what the noise's own uncertainty could hide."""
        return max(self.base - self.floor, _LEAST_EXCESS * self.floor)

    @property
    def winner(self) -> str | None:
        """The effect whose full fit is best, if what it removes is not noise and its values are not on a bound."""
        found = plausible(self.finals)
        if self.chance >= SIGNIFICANT or not found:
            return None
        return min(found, key=lambda effect: self.squares[effect])

    def removed(self, effect: str) -> float:
        """Share of the excess over the noise that an effect removes, 0 to 1."""
        drop = self.base - self.squares.get(effect, self.base)
        return float(np.clip(drop / self.excess, 0.0, 1.0))


def on_own_bound(effect: str, fit: FitResult) -> bool:
    """Whether a fit had to stop at the edge of the plausible range of one of the effect's own parameters.

    A part of the effect that is not there (at its null) or that nothing shows does not count.
    """
    kind = next(e for e in fit.model.effects if e.id == effect)
    names = {f"{effect}.{p.name}": p.null for p in kind.parameters}
    return any(
        name in names
        and name not in fit.undetermined
        and not np.isclose(fit.model.values[name], names[name], atol=1e-6)
        for name in fit.at_bound
    )


def plausible(finals: dict[str, FitResult]) -> dict[str, FitResult]:
    """The fits, by effect, that did not have to stop at the edge of the effect's range."""
    return {effect: final for effect, final in finals.items() if not on_own_bound(effect, final)}


def expected_squares(fitted: np.ndarray, noise: NoiseModel, runs: np.ndarray) -> float:
    """Expected sum of squares of the noise after the fitted directions [frames, n] and run means are taken out."""
    basis = orthonormal(fitted)
    draws = noise.sample(runs, 100, np.random.default_rng(1))
    draws -= basis @ (basis.T @ draws)
    return float((draws**2).sum(axis=0).mean())


def finding(context: Context, effect) -> Finding:
    """The verdict on one effect, judged beside the winner: what the winner explains accuses nobody else."""
    name = effect.id
    units = {f"{name}.{p.name}": p.unit for p in effect.parameters}
    seen = context.signatures.get(name)
    if seen is None:
        return Finding(
            name, Verdict.INCONCLUSIVE, 0.0, 0.0, {}, units, 1.0, float("inf"), source=effect.source
        )
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
    return Finding(
        name, verdict, 0.0, removed, expected, units, seen.swallowed, limit, final, source=effect.source
    )


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
    if effect.id == context.winner and removed >= _MATTERS:
        return Verdict.MISSING, limit
    first = next((p for p in effect.parameters if not p.scan), effect.parameters[0])
    widest = max(abs(first.lower - first.null), abs(first.upper - first.null))
    if limit > widest or not np.isfinite(limit):
        return Verdict.CANNOT_BE_SEEN, limit
    if effect.id == context.winner or abs(size) > _DETECTION * error:
        return Verdict.MISSING_IF_SIZE_MATTERS, limit
    return (Verdict.ABSENT if limit <= abs(first.typical - first.null) else Verdict.INCONCLUSIVE), limit


def probabilities(context: Context) -> tuple[dict[str, float], float]:
    """Probability of each effect being the missing one, and of none of them.

    Weights exp(-(S - S_best) / 2 v), v the noise's variance in the direction of a typical signature (which correlated
    noise makes larger than that of a frame), with half a logarithm of the frames per parameter added, as BIC does. What
    the best leaves above the noise counts for "none of them".
    """
    evaluation = context.fit.evaluation
    variance = _directional_variance(context)
    frames = np.log(len(evaluation.residual))
    tolerance = 2 * variance + 0.01 * context.excess
    scores = {}
    for name, squares in context.squares.items():
        count = context.signatures[name].columns.shape[1] - 1 if name in context.signatures else 1
        scores[name] = -squares / tolerance - 0.5 * count * frames
    nothing = -context.base / tolerance
    best = max([nothing, *scores.values()])
    weights = {name: float(np.exp(score - best)) for name, score in scores.items()}
    weight_nothing = float(np.exp(nothing - best))
    unexplained = 1 - max((context.removed(name) for name in scores), default=0.0)
    some = context.chance < SIGNIFICANT
    none = float(np.clip((unexplained - 0.05) / 0.3, 0.0, 1.0)) if some else 1.0
    total = sum(weights.values()) + weight_nothing
    share = 1 - none if some else 0.0
    return {
        name: share * weights.get(name, 0.0) / total for name in context.signatures | context.squares
    }, none


def _directional_variance(context: Context) -> float:
    runs = context.fit.evaluation.runs
    values = []
    for seen in context.signatures.values():
        power = float(seen.left @ seen.left)
        if power > 1e-20:
            unit = seen.left / np.sqrt(power)
            values.append(float(unit @ context.noise.covariance_product(unit[:, None], runs)[:, 0]))
    return float(np.median(values)) if values else context.noise.standard_deviation**2


def groups(context: Context) -> list[tuple[str, ...]]:
    """Groups of effects that these recordings cannot tell apart, the winner's first.

    The winner's partners are those whose fit comes as close as the noise and a small share of the excess allow; other
    pairs are judged by how alike what they leave is.
    """
    found: list[set[str]] = []
    winner = context.winner
    if winner is not None:
        slack = 6 * _directional_variance(context) + _TOLD_APART * context.excess
        partners = {n for n, s in context.squares.items() if s - context.squares[winner] <= slack}
        found.append(partners | {winner})
    names = [
        name for name, seen in context.signatures.items() if np.any(seen.left) and seen.swallowed < 0.999
    ]
    for index, one in enumerate(names):
        for other in names[index + 1 :]:
            if alike(context.signatures[one], context.signatures[other]) > _ALIKE:
                _join(found, {one, other}, keep_first=winner is not None)
    return [tuple(sorted(group)) for group in found if len(group) > 1]


def _join(found: list[set[str]], pair: set[str], keep_first: bool) -> None:
    for group in found[1 if keep_first else 0 :]:
        if group & pair:
            group |= pair
            return
    found.append(pair)
