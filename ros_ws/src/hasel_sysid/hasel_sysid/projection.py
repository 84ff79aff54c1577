# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Projections onto the span of columns, and onto what a saturated model can say.

The saturated model predicts the residual by a linear combination of what drives the body and how it moves: an upper
bound of what any effect could explain, and never an explanation.
"""

import numpy as np

from hasel_sysid.problem import Evaluation

_LAGS_S = (0.0, 0.03, 0.1, 0.3)


def orthonormal(columns: np.ndarray) -> np.ndarray:
    """An orthonormal basis of the span of columns [frames, n]."""
    if columns.shape[1] == 0:
        return columns
    scale = np.linalg.norm(columns, axis=0)
    left, strength, _ = np.linalg.svd(columns[:, scale > 0] / scale[scale > 0], full_matrices=False)
    return left[:, strength > 1e-8 * strength[0]] if len(strength) else left


def drops(columns: np.ndarray, basis: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """By how much columns [frames, n] lower a residual's sum of squares beyond what a basis [frames, m] already does.

    residual [frames] or [frames, draws]; returns one drop for each, [] or [draws].
    """
    directions = orthonormal(columns - basis @ (basis.T @ columns))
    return ((directions.T @ residual) ** 2).sum(axis=0)


def regressors(evaluation: Evaluation) -> np.ndarray:
    """Features of every frame, the mean of every series removed and scaled to unit length, [frames, features]."""
    parts = []
    for simulation, output, used, _ in evaluation.each_series():
        moved = np.nan_to_num(simulation.outputs[:, output])
        parts.append(_features(simulation.time, moved, simulation.contraction)[used])
    columns = np.concatenate(parts)
    for one in np.unique(evaluation.series):
        here = evaluation.series == one
        columns[here] -= columns[here].mean(axis=0)
    length = np.linalg.norm(columns, axis=0)
    return columns[:, length > 1e-9] / length[length > 1e-9]


def _features(time: np.ndarray, angle: np.ndarray, contraction: np.ndarray) -> np.ndarray:
    rate = np.gradient(angle, time)
    acceleration = np.gradient(rate, time)
    contraction = np.nan_to_num(contraction, nan=0.0)
    together = contraction.sum(axis=1)
    difference = 2 * contraction[:, 0] - together if contraction.shape[1] else together
    elapsed = time - time[0]
    lagged = [np.interp(time - lag, time, difference, left=0.0) for lag in _LAGS_S]
    return np.stack(
        [angle, rate, acceleration, angle**3, angle * np.abs(angle), rate * np.abs(rate), angle**2 * rate]
        + [np.tanh(10 * rate), angle * elapsed, elapsed, together, difference**3, *lagged],
        axis=1,
    )


def unexplained_by(columns: np.ndarray, residual: np.ndarray) -> np.ndarray:
    """The part of a residual [frames] outside the span of columns [frames, n]."""
    if columns.shape[1] == 0:
        return residual
    left, strength, _ = np.linalg.svd(columns, full_matrices=False)
    basis = left[:, strength > 1e-9 * strength[0]]
    return residual - basis @ (basis.T @ residual)
