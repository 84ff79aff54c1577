# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Statistics that hold for correlated noise, single jumps and runs that disagree."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

_KERNEL = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
_TO_SIGMA = 1.4826
_CORRELATION_S = 0.1
"""Errors further apart than this count as independent."""
_CLEAR = 3.0


def high_frequency_noise(series: np.ndarray) -> float:
    """Standard deviation of the frame-to-frame noise in a series [n]; 0 for fewer than 8 frames.

    Fourth differences take out what moves smoothly; their median absolute value is robust against single jumps.
    Noise that is correlated from frame to frame is underestimated.
    """
    if len(series) < 8:
        return 0.0
    differences = np.convolve(series, _KERNEL, mode="valid")
    return float(_TO_SIGMA * np.median(np.abs(differences)) / np.linalg.norm(_KERNEL))


@dataclass(frozen=True)
class Regression:
    """coefficients and standard_errors [k]; residual [n]; covariance [k, k]."""

    coefficients: np.ndarray
    covariance: np.ndarray
    residual: np.ndarray

    @property
    def standard_errors(self) -> np.ndarray:
        """Square roots of the variances, [k]."""
        return np.sqrt(np.maximum(np.diag(self.covariance), 0.0))

    @property
    def sum_of_squares(self) -> float:
        """Sum of the squared residuals."""
        return float(self.residual @ self.residual)


def regress(series: np.ndarray, columns: np.ndarray, frame_time: float) -> Regression:
    """Fit series [n] by columns [n, k], frames frame_time [s] apart.

    Standard errors: Newey and West, Econometrica 55 (1987) 703, heteroscedasticity and autocorrelation consistent.
    """
    lags = int(
        np.clip(round(_CORRELATION_S / frame_time) if frame_time > 0 else 1, 1, max(1, len(series) // 4))
    )
    inverse = np.linalg.pinv(columns)
    coefficients = inverse @ series
    residual = series - columns @ coefficients
    bread = inverse @ inverse.T
    covariance = bread @ _long_run_covariance(columns * residual[:, None], lags) @ bread
    count, parameters = columns.shape
    return Regression(coefficients, covariance * count / max(count - parameters, 1), residual)


def _long_run_covariance(scores: np.ndarray, lags: int) -> np.ndarray:
    """Sum of the autocovariances of scores [n, k] up to `lags`, with Bartlett's weights, [k, k]."""
    total = scores.T @ scores
    for lag in range(1, lags + 1):
        one_way = scores[lag:].T @ scores[:-lag]
        total = total + (1.0 - lag / (lags + 1)) * (one_way + one_way.T)
    return total


@dataclass(frozen=True)
class Pooled:
    """Mean over runs of equal weight up to their errors; scatter: standard deviation between runs beyond the errors."""

    mean: float
    standard_error: float
    scatter: float


def pool(values: Sequence[float] | np.ndarray, errors: Sequence[float] | np.ndarray) -> Pooled:
    """Random-effects mean of values [n] with standard errors [n] (DerSimonian and Laird, 1986)."""
    value, variance = np.asarray(values, float), np.maximum(np.asarray(errors, float) ** 2, 1e-30)
    weight = 1.0 / variance
    fixed = float((weight * value).sum() / weight.sum())
    excess = float((weight * (value - fixed) ** 2).sum()) - (len(value) - 1)
    scale = float(weight.sum() - (weight**2).sum() / weight.sum())
    between = max(0.0, excess / scale) if scale > 0 else 0.0
    weight = 1.0 / (variance + between)
    return Pooled(float((weight * value).sum() / weight.sum()), float(weight.sum() ** -0.5), between**0.5)


def standing_out(
    conditions: Sequence[float], values: Sequence[float], errors: Sequence[float]
) -> float | None:
    """The condition (such as 3.5 Hz) where the value, in the direction of its mean, stands out; None when none does.

    Standing out: half as large again as elsewhere and further away than three standard errors.
    """
    condition, value, error = (np.asarray(part, float) for part in (conditions, values, errors))
    groups = {c: pool(value[condition == c], error[condition == c]) for c in np.unique(condition)}
    if len(groups) < 2:
        return None
    sign = np.sign(pool(value, error).mean) or 1.0
    most = max(groups, key=lambda c: sign * groups[c].mean)
    others = pool(value[condition != most], error[condition != most])
    difference = sign * (groups[most].mean - others.mean)
    clear = _CLEAR * np.hypot(groups[most].standard_error, others.standard_error)
    return float(most) if difference > clear and difference > 0.5 * abs(others.mean) else None
