"""The residual by phase of the drive's cycle."""

from dataclasses import dataclass

import numpy as np

from hasel_sysid.where_it_fails.run_series import RunSeries

BINS = 20


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

    @property
    def worst_phase(self) -> float:
        """Centre of the bin with the largest mean magnitude, 0 to 1."""
        return float(self.phase[int(np.nanargmax(self.absolute))])


def phase_profile(run: RunSeries, bins: int = BINS) -> PhaseProfile | None:
    """Profile of one run; None without a cycle."""
    if run.cycle is None or len(run.time) < 2 or run.cycle.count(run.time) < 0.5:
        return None
    driven = run.time >= run.cycle.start
    residual, time = run.residual[driven], run.time[driven]
    index = np.minimum((run.cycle.phase(time) * bins).astype(int), bins - 1)
    count = np.bincount(index, minlength=bins).astype(float)
    count[count == 0] = np.nan
    centres = (np.arange(bins) + 0.5) / bins
    return PhaseProfile(
        centres,
        np.bincount(index, residual, bins) / count,
        np.bincount(index, np.abs(residual), bins) / count,
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
