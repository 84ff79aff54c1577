"""How well a fitted model predicts runs that it was not fitted to, without simulating anything again."""

import numpy as np

from hasel_sysid.diagnosis.conditions import conditions
from hasel_sysid.problem import Evaluation
from hasel_sysid.projection import orthonormal

_DETERMINED = 0.2
"""Share of all information about a direction that the runs but one must hold to foretell that one."""
_FEWEST_RUNS, _BLOCKS = 4, 4
"""Fewer runs do not tell how much their gains scatter."""


def foretells_better(before: Evaluation, after: Evaluation) -> bool:
    """Whether a model predicts what it is not fitted to better than another one does.

    Left out are one run after the other, where the mean gain must exceed its standard error (the one-standard-error
    rule; Breiman et al. 1984), and all runs of one voltage and of one frequency, where it must be a gain. Of a single
    run its quarters are left out.
    """
    folds = before.runs
    alone = folds.min() == folds.max()
    if alone:
        folds = _BLOCKS * np.arange(len(folds)) // len(folds)
    gains = left_out_squares(before, folds) - left_out_squares(after, folds)
    if gains.sum() <= 0:
        return False
    if not alone and len(gains) >= _FEWEST_RUNS and gains.mean() < gains.std(ddof=1) / np.sqrt(len(gains)):
        return False
    return all(
        left_out_squares(after, folds).sum() < left_out_squares(before, folds).sum()
        for folds in _by_condition(before)
    )


def left_out_squares(evaluation: Evaluation, folds: np.ndarray) -> np.ndarray:
    """Sum of squared residuals of every fold when the parameters are fitted to the other folds only, [folds].

    folds [frames]: number of the fold that each frame belongs to. The refit is linearised at the fit to all runs.
    Directions that the other runs hardly determine stay as they are: a run that alone tells a muscle's amplitude cannot
    be left out of it, and so far away derivatives say nothing.
    """
    directions, residual = orthonormal(evaluation.jacobian), evaluation.residual
    squares = []
    for fold in np.unique(folds):
        here = folds == fold
        others = directions[~here]
        information, axes = np.linalg.eigh(others.T @ others)
        known = information > _DETERMINED
        axes, information = axes[:, known], information[known]
        change = axes @ (axes.T @ (others.T @ residual[~here]) / information)
        left = residual[here] - directions[here] @ change
        squares.append(float(left @ left))
    return np.array(squares)


def _by_condition(evaluation: Evaluation) -> list[np.ndarray]:
    """Folds [frames] of equal voltage and of equal frequency, where either varies."""
    found = []
    for values in conditions(evaluation.simulations).values():
        numbers = np.unique(np.round(values, 6), return_inverse=True)[1]
        if np.isfinite(values).all() and numbers.max() > 0:
            found.append(numbers[evaluation.runs])
    return found
