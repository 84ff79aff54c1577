"""Whether the body bends more to one side than the simulation, and the half-wave symmetry of a series."""

import numpy as np
from scipy.interpolate import CubicSpline

from hasel_sysid.where_it_fails.component import Component, Kind
from hasel_sysid.where_it_fails.components.added import explained_by
from hasel_sysid.where_it_fails.components.aligned import Alignment
from hasel_sysid.where_it_fails.drive_cycle import comparable, driven_side
from hasel_sysid.where_it_fails.run_series import RunSeries


def half_wave_asymmetry(time: np.ndarray, series: np.ndarray, period: float) -> float:
    """Rms of (x(t) + x(t + T/2)) / 2 less its mean: what a half-wave symmetric series does not have.

    time [s] [n], series [n], period T [s]. Half a period need not be a whole number of frames (cubic interpolation).
    NaN when less than half a period is left to compare.
    """
    early = time <= time[-1] - period / 2
    if np.count_nonzero(early) < 4:
        return float("nan")
    even = 0.5 * (series[early] + CubicSpline(time, series)(time[early] + period / 2))
    return float(np.std(even))


def _driven_both_ways(run: RunSeries) -> bool:
    side = driven_side(comparable(run.drive_values, run.channels))
    return bool(np.any(side > 0) and np.any(side < 0))


def upper_against_lower(run: RunSeries, aligned: Alignment) -> Component | None:
    """Bending to the lower side relative to the upper, less one; None when the run is driven or bends to one side only.

    A body that only one channel bends has two sides merely because its offset is taken out.
    """
    if not _driven_both_ways(run):
        return None
    up, down = aligned.shifted.max(), -aligned.shifted.min()
    if min(up, down) < 0.1 * max(up, down):
        return None
    fitted, size = explained_by(aligned, np.abs(aligned.shifted)[:, None], run.frame_time)
    difference, error = float(fitted.coefficients[0]), float(fitted.standard_errors[0])
    upper, lower = aligned.gain + difference, aligned.gain - difference
    if abs(upper) < 1e-6:
        return None
    detail = {"gain_upper": upper, "gain_lower": lower}
    if run.cycle is not None:
        residual = half_wave_asymmetry(run.time, run.residual, run.cycle.period)
        detail["half_wave_asymmetry"] = residual
    relative_error = 2.0 * abs(aligned.gain) / upper**2 * error
    return Component(Kind.UPPER_AGAINST_LOWER, lower / upper - 1.0, relative_error, "1", size, detail)
