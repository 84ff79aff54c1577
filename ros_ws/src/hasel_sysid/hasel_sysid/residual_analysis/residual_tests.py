# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Is a residual white, does it depend on the drive, and on the phase of its cycle?"""

from dataclasses import dataclass

import numpy as np
from hasel_recording.recording import held
from scipy.special import chdtrc, ndtri

from hasel_sysid.residual_analysis.drive_cycle import comparable, net_drive
from hasel_sysid.residual_analysis.run_series import RunSeries

LAGS = 25
_LONGEST_S = 0.4
BINS = 20


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


def whiteness(residual: np.ndarray, frame_time: float) -> Whiteness | None:
    """Test a residual [n], frames frame_time [s] apart; None for fewer than 20 frames or a constant.

    Robust standardised autocorrelations of Dalla, Giraitis and Phillips, Econometric Theory 38 (2022) 913.
    """
    centred = residual - residual.mean()
    count = min(LAGS, len(centred) // 4)
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


@dataclass(frozen=True)
class DriveDependence:
    """lag_time [s] [lags]: residual after command; correlation [lags]; band: 99 % half width if independent."""

    lag_time: np.ndarray
    correlation: np.ndarray
    band: float

    @property
    def strongest(self) -> tuple[float, float]:
        """Lag [s] and correlation of the largest magnitude."""
        index = int(np.argmax(np.abs(self.correlation)))
        return float(self.lag_time[index]), float(self.correlation[index])

    @property
    def depends(self) -> bool:
        """Whether the largest correlation leaves the band."""
        return abs(self.strongest[1]) > self.band

    def __str__(self) -> str:
        lag, value = self.strongest
        if self.band >= 1.0:
            return "Whether the residual depends on the drive cannot be told: the run holds too few cycles."
        if not self.depends:
            return f"The residual does not depend on the drive (correlation within ±{self.band:.2f})."
        return (
            f"The residual depends on the drive: correlation {value:+.2f} (band ±{self.band:.2f}) with the command "
            f"{lag * 1e3:.0f} ms before, so what follows that command is not fully described."
        )


def drive_dependence(run: RunSeries) -> DriveDependence | None:
    """Correlate the drive (upper less lower, see net_drive) with the residual; None for a passive or constant one.

    The band is Bartlett's for two correlated series: variance of the correlation = sum of the products of both
    autocorrelations over n, widened for looking at many lags.
    """
    if run.drive is None or len(run.time) < 20:
        return None
    drive_time, drive_values = run.drive
    net = net_drive(comparable(drive_values, run.channels))
    command = held(drive_time, net, run.time + 1e-9)
    command = command - command.mean()
    residual = run.residual
    scale = np.sqrt(float(command @ command) * float(residual @ residual))
    if scale == 0:
        return None
    lags = int(min(len(residual) // 3, round(_LONGEST_S / run.frame_time)))
    values = [float(command[: len(command) - lag] @ residual[lag:]) / scale for lag in range(lags + 1)]
    both = _autocorrelation(command, lags) * _autocorrelation(residual, lags)
    taper = 1 - np.arange(lags + 1) / (lags + 1)
    variance = max(1.0 + 2.0 * float((taper * both)[1:].sum()), 1.0) / len(residual)
    independent = max(1.0, (lags + 1) / max(1.0, variance * len(residual)))
    band = ndtri(1 - 0.005 / independent) * np.sqrt(variance)
    return DriveDependence(np.arange(lags + 1) * run.frame_time, np.array(values), float(band))


def _autocorrelation(series: np.ndarray, lags: int) -> np.ndarray:
    power = float(series @ series)
    return np.array([float(series[: len(series) - lag] @ series[lag:]) / power for lag in range(lags + 1)])


@dataclass(frozen=True)
class PhaseProfile:
    """phase: centre of every bin, 0 to 1, [bins]; mean, absolute: mean and mean magnitude of the residual [bins].

    repeats: correlation of the residual between one cycle and the next: 1 when the drive determines it, 0 when it is
    noise; NaN with less than two cycles, or where the residual does not change, as that of a perfect model.
    """

    phase: np.ndarray
    mean: np.ndarray
    absolute: np.ndarray
    repeats: float


def phase_profile(run: RunSeries) -> PhaseProfile | None:
    """Profile of one run; None without a cycle."""
    if run.cycle is None or len(run.time) < 2 or run.cycle.count(run.time) < 0.5:
        return None
    driven = run.time >= run.cycle.start
    residual, time = run.residual[driven], run.time[driven]
    index = np.minimum((run.cycle.phase(time) * BINS).astype(int), BINS - 1)
    count = np.bincount(index, minlength=BINS).astype(float)
    count[count == 0] = np.nan
    centres = (np.arange(BINS) + 0.5) / BINS
    return PhaseProfile(
        centres,
        np.bincount(index, residual, BINS) / count,
        np.bincount(index, np.abs(residual), BINS) / count,
        _repeats(time, residual, run.cycle.period),
    )


def _repeats(time: np.ndarray, residual: np.ndarray, period: float) -> float:
    earlier = time + period <= time[-1]
    if time[-1] - time[0] < 1.9 * period or np.count_nonzero(earlier) < 8:
        return float("nan")
    now, later = residual[earlier], np.interp(time[earlier] + period, time, residual)
    if np.ptp(now) == 0 or np.ptp(later) == 0:
        return float("nan")
    return float(np.corrcoef(now, later)[0, 1])
