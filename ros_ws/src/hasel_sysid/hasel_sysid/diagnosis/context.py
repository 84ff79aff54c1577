"""What every verdict of a diagnosis rests on."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.explained import share_left
from hasel_sysid.diagnosis.left_out import foretells_better
from hasel_sysid.diagnosis.signature import Signature
from hasel_sysid.diagnosis.trial import Trial
from hasel_sysid.fit.result import FitResult
from hasel_sysid.noise import NoiseModel
from hasel_sysid.projection import orthonormal

SIGNIFICANT = 0.01
"""Chance that noise alone looks like this below which something is missing."""
_LEAST_EXCESS = 0.05


@dataclass(frozen=True)
class Context:
    """Everything a verdict rests on.

    effects: what is judged; squares: sum of squared residuals reached with each; changes: of the simulated series by
    finer numerics; noise: what a right model may leave, discrepancy allowed for; measured: the noise alone; trials: the
    best of every effect; untried: effects for which there was no time.
    """

    effects: Sequence[Effect]
    fit: FitResult
    finals: dict[str, FitResult]
    signatures: dict[str, Signature]
    squares: dict[str, float]
    noise: NoiseModel
    floor: float
    chance: float
    changes: dict[str, np.ndarray]
    measured: NoiseModel | None = None
    trials: Mapping[str, Trial] = field(default_factory=dict)
    untried: frozenset[str] = frozenset()

    @property
    def base(self) -> float:
        """Sum of squares without any effect."""
        return self.fit.evaluation.sum_of_squares

    @property
    def excess(self) -> float:
        """Sum of squares above the noise; never less than what the noise's own uncertainty could hide."""
        return max(self.base - self.floor, _LEAST_EXCESS * self.floor)

    @cached_property
    def winner(self) -> str | None:
        """The effect with the best score of those with a plausible full fit, if what it removes is not noise."""
        found = plausible(self.finals, self.fit)
        if self.chance >= SIGNIFICANT or not found:
            return None
        return max(found, key=self.score)

    @cached_property
    def refuted(self) -> frozenset[str]:
        """Effects whose full fit stopped at the edge of their range or does not foretell runs that are left out."""
        return frozenset(self.finals) - frozenset(plausible(self.finals, self.fit))

    def with_fit(self, effect: str, fit: FitResult) -> "Context":
        """The same with one more effect fitted in full."""
        squares = {**self.squares, effect: fit.evaluation.sum_of_squares}
        return replace(self, finals={**self.finals, effect: fit}, squares=squares)

    def removed(self, effect: str) -> float:
        """Share of the squares above the noise that an effect removes, 0 to 1: to compare effects, not to tell."""
        drop = self.base - self.squares.get(effect, self.base)
        return float(np.clip(drop / self.excess, 0.0, 1.0))

    def error_removed(self, effect: str) -> float:
        """Share of the mean error above the noise that an effect removes, 0 to 1.

        Of what was not fitted in full only squares are known; their root stands for the mean error.
        """
        before = self.fit.evaluation.mean_absolute_error
        if effect in self.finals:
            after = self.finals[effect].evaluation.mean_absolute_error
        else:
            after = (
                before * float(np.sqrt(self.squares.get(effect, self.base) / self.base))
                if self.base > 0
                else 0.0
            )
        return 1.0 - share_left(before, after, self.noise.mean_absolute)

    def score(self, effect: str) -> float:
        """Logarithm of an effect's weight, up to a constant."""
        count = self.signatures[effect].columns.shape[1] - 1 if effect in self.signatures else 1
        return self.logarithmic_weight(self.squares[effect], count)

    def logarithmic_weight(self, squares: float, count: int) -> float:
        """Of a sum of squares that so many values of effects reach, up to a constant: log-likelihood, less half a
        logarithm of the frames per value, as BIC does.
        """
        frames = len(self.fit.evaluation.residual)
        return -squares / self.tolerance - 0.5 * count * float(np.log(frames))

    @property
    def tolerance(self) -> float:
        """Sums of squares that differ by less can hardly be told apart: no model is exact."""
        return 2 * self.directional_variance + 0.01 * self.excess

    @cached_property
    def directional_variance(self) -> float:
        """The noise's variance in the direction of a typical signature; correlation makes it more than a frame's."""
        runs = self.fit.evaluation.runs
        values = []
        for seen in self.signatures.values():
            power = float(seen.left @ seen.left)
            if power > 1e-20:
                unit = seen.left / np.sqrt(power)
                values.append(float(unit @ self.noise.covariance_product(unit[:, None], runs)[:, 0]))
        return float(np.median(values)) if values else self.noise.standard_deviation**2


def lowest_squares(fit: FitResult, finals: dict[str, FitResult]) -> float:
    """Sum of squares of the best of all fits, the one without any effect among them."""
    return min(one.evaluation.sum_of_squares for one in (fit, *finals.values()))


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


def plausible(finals: dict[str, FitResult], fit: FitResult) -> dict[str, FitResult]:
    """The fits, by effect, that did not have to stop at the edge of the effect's range, and foretell runs that are left
    out better than `fit` without it does.
    """
    return {
        effect: final
        for effect, final in finals.items()
        if not on_own_bound(effect, final) and foretells_better(fit.evaluation, final.evaluation)
    }


def expected_squares(fitted: np.ndarray, noise: NoiseModel, runs: np.ndarray) -> float:
    """Expected sum of squares of the noise after the fitted directions [frames, n] and run means are taken out."""
    basis = orthonormal(fitted)
    draws = noise.sample(runs, 100, np.random.default_rng(1))
    draws -= basis @ (basis.T @ draws)
    return float((draws**2).sum(axis=0).mean())
