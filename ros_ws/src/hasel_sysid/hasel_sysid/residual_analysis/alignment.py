# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How much one further column explains beyond offset, gain and lag."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import minimize_scalar

from hasel_sysid.residual_analysis.component import Component, Kind
from hasel_sysid.residual_analysis.robust_statistics import Regression, regress
from hasel_sysid.residual_analysis.run_series import RunSeries

_LARGEST_LAG_S = 0.3


@dataclass(frozen=True)
class Alignment:
    """measured(t) = offset + gain * simulated(t - lag) + remainder.

    shifted: simulated(t - lag) [n]; rate: its derivative [1/s] [n]; remainder [n]; components: offset, gain and lag.
    """

    gain: float
    lag: float
    shifted: np.ndarray
    rate: np.ndarray
    remainder: np.ndarray
    components: tuple[Component, ...]

    @property
    def columns(self) -> np.ndarray:
        """What offset, gain and lag can explain to first order, [n, 3]."""
        return np.column_stack([np.ones_like(self.shifted), self.shifted, -self.gain * self.rate])


def _shift(run: RunSeries, lag: float) -> np.ndarray:
    return np.interp(run.time - lag, run.time, run.simulated)


def _misfit(run: RunSeries, lag: float) -> float:
    """Sum of squares left by the best offset and gain at one lag [s]."""
    shifted = _shift(run, lag)
    centred, measured = shifted - shifted.mean(), run.measured - run.measured.mean()
    power = centred @ centred
    left = measured - centred * (centred @ measured / power if power > 0 else 0.0)
    return float(left @ left)


def _best_lag(run: RunSeries) -> float:
    """The lag [s] with the least misfit; at most a quarter of the cycle, beyond which gain and lag mix."""
    span = run.time[-1] - run.time[0]
    largest = min(_LARGEST_LAG_S, 0.25 * (1 / run.frequency if run.frequency else span))
    trials = np.arange(-largest, largest + 1e-12, max(run.frame_time, largest / 100))
    best = trials[int(np.argmin([_misfit(run, lag) for lag in trials]))]
    step = trials[1] - trials[0]
    bounds = (max(-largest, best - step), min(largest, best + step))
    return float(minimize_scalar(lambda lag: _misfit(run, lag), bounds=bounds, method="bounded").x)


def align(run: RunSeries) -> Alignment:
    """Find offset, gain and lag of a run."""
    lag = _best_lag(run)
    shifted = _shift(run, lag)
    rate = np.gradient(shifted, run.time)
    ones, count = np.ones_like(shifted), len(shifted)
    gain = float(np.polyfit(shifted, run.measured, 1)[0]) if np.ptp(shifted) > 0 else 1.0
    fitted = regress(
        run.measured - gain * shifted, np.column_stack([ones, shifted, -gain * rate]), run.frame_time
    )
    lag_error, gain_error, offset_error = (float(fitted.standard_errors[i]) for i in (2, 1, 0))
    remainder = run.measured - gain * shifted
    remainder = remainder - remainder.mean()
    left = float(remainder @ remainder)
    unlagged = _misfit(run, 0.0)
    ungained = run.measured - shifted
    ungained = float(((ungained - ungained.mean()) ** 2).sum())

    def size(without: float) -> float:
        return float(np.sqrt(max(without - left, 0.0) / count))

    return Alignment(
        gain,
        lag,
        shifted,
        rate,
        remainder,
        (
            Component(Kind.OFFSET, run.offset, offset_error, "1", abs(run.offset)),
            Component(Kind.GAIN, gain - 1.0, gain_error, "1", size(ungained)),
            Component(Kind.LAG, lag, lag_error, "s", size(unlagged)),
        ),
    )


def explained_by(aligned: Alignment, columns: np.ndarray, frame_time: float) -> tuple[Regression, float]:
    """Regression of the remainder on further columns [n, k] and the rms of sin theta they account for.

    The coefficients of the further columns come first.
    """
    base = regress(aligned.remainder, aligned.columns, frame_time)
    both = regress(aligned.remainder, np.column_stack([columns, aligned.columns]), frame_time)
    drop = max(base.sum_of_squares - both.sum_of_squares, 0.0)
    return both, float(np.sqrt(drop / len(aligned.remainder)))
