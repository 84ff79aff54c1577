"""Whether a residual still depends on the drive: cross-correlation of command and residual."""

from dataclasses import dataclass

import numpy as np
from hasel_recording.recording import held
from scipy.special import ndtri

from hasel_sysid.where_it_fails.drive_cycle import comparable, net_drive
from hasel_sysid.where_it_fails.run_series import RunSeries

_LONGEST_S = 0.4


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
    if run.drive_time is None or len(run.time) < 20:
        return None
    net = net_drive(comparable(run.drive_values, run.channels))
    command = held(run.drive_time, net, run.time + 1e-9)
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
