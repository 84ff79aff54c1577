"""Whether a residual is white: autocorrelation with a band that holds whatever the noise's variance does."""

from dataclasses import dataclass

import numpy as np
from scipy.special import chdtrc, ndtri

LAGS = 25


@dataclass(frozen=True)
class Whiteness:
    """lag_time [s] [lags]; autocorrelation [lags]; band [lags]: 99 % half width for white noise.

    probability: of a cumulated autocorrelation like this one in white noise; correlation_time [s]: 1 + 2 sum of the
    autocorrelation up to its first zero, in time.
    """

    lag_time: np.ndarray
    autocorrelation: np.ndarray
    band: np.ndarray
    probability: float
    correlation_time: float

    @property
    def is_white(self) -> bool:
        """Whether nothing speaks against white noise at 1 %."""
        return self.probability >= 0.01

    def __str__(self) -> str:
        if self.is_white:
            return f"The residual is white within its band (p = {self.probability:.2g})."
        return (
            f"The residual is not white: errors stay alike for {self.correlation_time * 1e3:.0f} ms "
            f"(autocorrelation {self.autocorrelation[0]:.2f} from frame to frame)."
        )


def whiteness(residual: np.ndarray, frame_time: float, lags: int = LAGS) -> Whiteness | None:
    """Test a residual [n], frames frame_time [s] apart; None for fewer than 20 frames or a constant.

    Robust standardised autocorrelations of Dalla, Giraitis and Phillips, Econometric Theory 38 (2022) 913.
    """
    centred = residual - residual.mean()
    count = min(lags, len(centred) // 4)
    power = float(centred @ centred)
    if len(centred) < 20 or power == 0:
        return None
    correlation, statistic = np.zeros(count), np.zeros(count)
    for lag in range(1, count + 1):
        products = centred[lag:] * centred[:-lag]
        correlation[lag - 1] = products.sum() / power
        statistic[lag - 1] = products.sum() / np.sqrt((products**2).sum())
    band = ndtri(0.995) * np.abs(correlation / np.where(statistic == 0, np.inf, statistic))
    crossing = np.flatnonzero(correlation <= 0)
    inside = correlation[: crossing[0] if len(crossing) else None].sum()
    return Whiteness(
        np.arange(1, count + 1) * frame_time,
        correlation,
        band,
        float(chdtrc(count, (statistic**2).sum())),
        float((1 + 2 * inside) * frame_time),
    )
