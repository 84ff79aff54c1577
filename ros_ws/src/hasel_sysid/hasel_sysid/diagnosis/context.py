"""What every verdict of a diagnosis rests on."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.explained import share_left
from hasel_sysid.diagnosis.signature import Signature
from hasel_sysid.diagnosis.trial import Trial
from hasel_sysid.estimation.bounds import further_without_bounds
from hasel_sysid.estimation.result import FitResult
from hasel_sysid.noise import NoiseModel
from hasel_sysid.policy import POLICY
from hasel_sysid.projection import orthonormal


@dataclass(frozen=True)
class Context:
    """Everything a verdict rests on.

    effects: what is judged; squares: sum of squared residuals reached with each; changes: of the simulated series by
    finer numerics; noise: what a right model may leave, discrepancy allowed for; measured: the noise alone; trials: the
    best of every effect; untried: effects for which there was no time; winner: the first effect of the chosen set.
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
    winner: str | None = None

    @property
    def base(self) -> float:
        """Sum of squares without any effect."""
        return self.fit.evaluation.sum_of_squares

    @property
    def excess(self) -> float:
        """Sum of squares above the noise; never less than what the noise's own uncertainty could hide."""
        return max(self.base - self.floor, POLICY.noise_known * self.floor)

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


def out_of_range(effect: str, fit: FitResult) -> bool:
    """Whether one of the effect's own parameters would have to lie beyond its plausible range.

    It ended on a bound, and would go on from there by more than noise explains.
    """
    return any(_surely_beyond(fit, name) for name in on_edge(effect, fit))


def on_edge(effect: str, fit: FitResult) -> list[str]:
    """The effect's own parameters that ended on a bound.

    A part of the effect that is not there (at its null) or that nothing shows does not count.
    """
    kind = next(e for e in fit.model.effects if e.id == effect)
    nulls = {f"{effect}.{p.name}": p.null for p in kind.parameters}
    return [
        name
        for name in fit.at_bound
        if name in nulls
        and name not in fit.undetermined
        and not np.isclose(fit.model.values[name], nulls[name], atol=1e-6)
    ]


def _surely_beyond(fit: FitResult, name: str) -> bool:
    error = fit.model.parameters[name].standard_error or 0.0
    return abs(further_without_bounds(fit.evaluation, name)) > POLICY.doubt * error


def expected_squares(fitted: np.ndarray, noise: NoiseModel, runs: np.ndarray) -> float:
    """Expected sum of squares of the noise after the fitted directions [frames, n] and run means are taken out."""
    basis = orthonormal(fitted)
    draws = noise.sample(runs, 100, np.random.default_rng(1))
    draws -= basis @ (basis.T @ draws)
    return float((draws**2).sum(axis=0).mean())
