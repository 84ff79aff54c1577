"""One run against its simulation."""

from dataclasses import dataclass

import numpy as np

from hasel_sysid.compare.swimming_speed import SwimmingSpeed
from hasel_sysid.where_it_fails.in_one_run import RunAnalysis
from hasel_sysid.where_it_fails.run_series import RunSeries


@dataclass(frozen=True)
class RunComparison:
    """series: what was compared, frame by frame; unseen: not used for fitting; analysis: where it fails.

    speed: of a body that swims and whose markers were recorded, else None.
    """

    series: RunSeries
    unseen: bool
    analysis: RunAnalysis
    speed: SwimmingSpeed | None = None

    @property
    def name(self) -> str:
        """Name of the recording."""
        return self.series.name

    @property
    def mean_absolute_error(self) -> float:
        """Mean |Δ sin θ|, the run's offset taken out."""
        return float(np.abs(self.series.residual).mean())

    @property
    def mean_absolute_error_raw(self) -> float:
        """Mean |Δ sin θ| with the offset left in."""
        return float(np.abs(self.series.measured - self.series.simulated).mean())

    @property
    def fit_percent(self) -> float:
        """100 (1 - |measured - simulated| / |measured - its mean|), offset taken out; 100 is a perfect model."""
        spread = float(np.linalg.norm(self.series.measured - self.series.measured.mean()))
        return (
            100.0 * (1.0 - float(np.linalg.norm(self.series.residual)) / spread)
            if spread > 0
            else float("nan")
        )

    def to_json(self) -> dict:
        """Plain numbers and words."""
        return {
            "name": self.name,
            "unseen": self.unseen,
            "drive": self.series.levels,
            "frequency": self.series.frequency,
            "frames": len(self.series.time),
            "mae": self.mean_absolute_error,
            "mae_raw": self.mean_absolute_error_raw,
            "offset": self.series.offset,
            "fit_percent": self.fit_percent,
            "noise": self.analysis.noise,
            "failures": [failure.to_json() for failure in self.analysis.failures],
            **self._speeds(),
        }

    def _speeds(self) -> dict[str, float]:
        if self.speed is None:
            return {}
        return {
            "speed_m_per_s": self.speed.measured,
            "simulated_speed_m_per_s": self.speed.simulated,
            "speed_error_m_per_s": self.speed.error,
        }

    def __str__(self) -> str:
        return (
            f"{self.name}: mean |Δ sin θ| = {self.mean_absolute_error:.5f} "
            f"({self.mean_absolute_error_raw:.5f} with the offset), fit {self.fit_percent:.1f} %."
        )

    __repr__ = __str__
