"""How well a muscle foretells voltages that it was not fitted to, and whether another does better by more than luck."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.muscle.muscle import Muscle

from hasel_sysid.bench_muscle.fit import fit_muscle
from hasel_sysid.bench_muscle.problem import BenchProblem

_MOST_FOLDS = 5
FEWEST_LEVELS = 5
"""With fewer voltages even a gain at every one of them could be chance, in more than one case of twenty."""
_EVERY_FLIP = 12


def levels_of(problem: BenchProblem) -> np.ndarray:
    """Voltages [V] of the lifts, ascending."""
    levels = np.unique(problem.levels[problem.driven])
    return levels[levels > 0]


def left_out_errors(problem: BenchProblem, muscle: Muscle) -> np.ndarray:
    """Mean square error of every level's holds by the answer's scale, fitted without that level, [levels].

    Levels are left out several at a time, spread over their range; the fits start from the muscle's values.
    """
    levels = levels_of(problem)
    folds = min(_MOST_FOLDS, len(levels))
    errors = np.zeros(len(levels))
    for fold in range(folds):
        out = levels[fold::folds]
        fitted = fit_muscle(problem.only_levels(out, keep=False), muscle, brief=True).muscle
        for level in out:
            left = problem.only_levels([level])
            errors[levels == level] = np.mean(left.per_hold(left.residual(fitted)))
    return errors


@dataclass(frozen=True)
class Advantage:
    """By what factor left-out errors fall [1], and how often chance alone would do as well [1]."""

    factor: float
    luck: float

    def __str__(self) -> str:
        return f"voltages left out are foretold {self.factor:.2g} times as well (by chance: {self.luck:.1g})"


def gains(
    before: np.ndarray | Sequence[float], after: np.ndarray | Sequence[float], noise: float
) -> np.ndarray:
    """Logarithm of the factor by which the error of every level falls, from mean squares; [levels].

    noise: mean square of the noise, below which nothing counts.
    """
    return 0.5 * np.log((np.asarray(before) + noise) / (np.asarray(after) + noise))


def advantages(each: Sequence[np.ndarray]) -> list[Advantage]:
    """What each of several rivals gains, by its gains at every level [levels].

    Chance: were a level as likely to lose as to gain, how often would the luckiest of all rivals have so large a mean
    by its spread (Westfall and Young 1993, with sign flips; Student's t as the statistic).
    """
    if not each:
        return []
    table = np.stack(each)
    flips = _flips(table.shape[1])
    luckiest = np.max([_student(flips * row) for row in table], axis=0)
    return [
        Advantage(float(np.exp(row.mean())), float(np.mean(luckiest >= _student(row[None])[0] - 1e-12)))
        for row in table
    ]


def _student(rows: np.ndarray) -> np.ndarray:
    """Mean by standard error of every row; 0 for a row of zeros."""
    mean, spread = rows.mean(axis=1), rows.std(axis=1, ddof=1)
    return mean * np.sqrt(rows.shape[1]) / np.maximum(spread, 1e-9)


def _flips(levels: int) -> np.ndarray:
    """Signs [flips, levels]: all there are, or many at random; the first leaves everything as it is."""
    if levels <= _EVERY_FLIP:
        every = (np.arange(2**levels)[:, None] >> np.arange(levels)) & 1
        return 1.0 - 2.0 * every
    flips = np.random.default_rng(0).choice([-1.0, 1.0], size=(2**_EVERY_FLIP, levels))
    flips[0] = 1.0
    return flips
