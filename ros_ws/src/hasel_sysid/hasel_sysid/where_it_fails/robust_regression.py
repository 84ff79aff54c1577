"""Least squares whose standard errors hold for correlated noise."""

from dataclasses import dataclass

import numpy as np

_CORRELATION_S = 0.1
"""Errors further apart than this count as independent."""


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
