# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Split the difference of one run into its components: offset, gain, lag, ringing, sides, drift, or a swing."""

import numpy as np
from scipy.interpolate import CubicSpline

from hasel_sysid.residual_analysis.alignment import Alignment, align, explained_by
from hasel_sysid.residual_analysis.component import Component, Kind
from hasel_sysid.residual_analysis.drive_cycle import comparable, driven_side
from hasel_sysid.residual_analysis.run_series import RunSeries
from hasel_sysid.residual_analysis.swing import free_swing

_CYCLES_IN_A_DECAY = (0.5, 1.0, 2.0, 5.0)
_HIGHEST_HZ = 25.0
_TRIALS = 40
_FEWEST_FRAMES = 16


def drift(run: RunSeries, aligned: Alignment) -> tuple[Component, Component]:
    """Change of the gain per second, relative to the gain [1/s], and of the offset [1/s]."""
    elapsed = run.time - run.time.mean()
    columns = np.column_stack([elapsed * aligned.shifted, elapsed])
    found = []
    for column in columns.T:
        fitted, size = explained_by(aligned, column[:, None], run.frame_time)
        found.append((float(fitted.coefficients[0]), float(fitted.standard_errors[0]), size))
    (gain, gain_error, gain_size), (offset, offset_error, offset_size) = found
    scale = abs(aligned.gain) or 1.0
    return (
        Component(Kind.GAIN_DRIFT, gain / scale, gain_error / scale, "1/s", gain_size),
        Component(Kind.OFFSET_DRIFT, offset, offset_error, "1/s", offset_size),
    )


def _oscillation(since: np.ndarray, side: np.ndarray, frequency: float, decay: float) -> np.ndarray:
    envelope = side * np.exp(-decay * since)
    angle = 2 * np.pi * frequency * since
    return np.column_stack([envelope * np.cos(angle), envelope * np.sin(angle)])


def _squares_explained(base: np.ndarray, left: np.ndarray, columns: np.ndarray) -> float:
    own = columns - base @ (base.T @ columns)
    coefficients = np.linalg.lstsq(own, left, rcond=None)[0]
    return float(left @ own @ coefficients)


def ringing(run: RunSeries, aligned: Alignment) -> Component | None:
    """The oscillation that explains most; None when the drive has no switches or too short a time between them.

    value: amplitude in sin theta just after a switch; detail: frequency_hz and decay_per_s.
    """
    if run.cycle is None or run.frame_time <= 0:
        return None
    between = float(np.median(np.diff(run.cycle.switches)))
    lowest, highest = 1.0 / between, min(_HIGHEST_HZ, 0.2 / run.frame_time)
    if highest <= lowest:
        return None
    trials = [
        (frequency, frequency / cycles)
        for frequency in np.geomspace(lowest, highest, _TRIALS)
        for cycles in _CYCLES_IN_A_DECAY
    ]
    since, side = run.cycle.since_switch(run.time)
    since = np.nan_to_num(since)
    base, _ = np.linalg.qr(aligned.columns)
    left = aligned.remainder - base @ (base.T @ aligned.remainder)
    frequency, decay = max(
        trials, key=lambda trial: _squares_explained(base, left, _oscillation(since, side, *trial))
    )
    fitted, size = explained_by(aligned, _oscillation(since, side, frequency, decay), run.frame_time)
    pair, covariance = fitted.coefficients[:2], fitted.covariance[:2, :2]
    amplitude = float(np.hypot(*pair))
    error = float(np.sqrt(max(pair @ covariance @ pair, 0.0))) / amplitude if amplitude > 0 else 0.0
    return Component(
        Kind.RINGING,
        amplitude,
        error,
        "1",
        size,
        {"frequency_hz": float(frequency), "decay_per_s": float(decay)},
    )


def rise_against_fall(run: RunSeries, aligned: Alignment) -> Component:
    """Lag while bending away minus lag while coming back [s]."""
    away = np.sign(run.simulated * np.gradient(run.simulated, run.time))
    fitted, size = explained_by(aligned, (-aligned.gain * aligned.rate * away)[:, None], run.frame_time)
    return Component(
        Kind.RISE_AGAINST_FALL,
        2.0 * float(fitted.coefficients[0]),
        2.0 * float(fitted.standard_errors[0]),
        "s",
        size,
        {
            "rise_lag_s": aligned.lag + float(fitted.coefficients[0]),
            "fall_lag_s": aligned.lag - float(fitted.coefficients[0]),
        },
    )


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


def upper_against_lower(run: RunSeries, aligned: Alignment) -> Component | None:
    """Bending to the lower side relative to the upper, less one; None when the run is driven or bends to one side only.

    A body that only one channel bends has two sides merely because its offset is taken out.
    """
    if run.drive_values is None:
        return None
    side = driven_side(comparable(run.drive_values, run.channels))
    if not (np.any(side > 0) and np.any(side < 0)):
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


def split(run: RunSeries) -> tuple[Component, ...]:
    """All components of a run, largest first; none for fewer than 16 frames.

    A body without drive is described by its swing, a driven one by gain, lag, sides, ringing and drift.
    """
    if len(run.time) < _FEWEST_FRAMES:
        return ()
    aligned = align(run)
    if run.drive_time is None or run.level == 0:
        found = [aligned.components[0], *free_swing(run)]
    else:
        found = [
            *aligned.components,
            rise_against_fall(run, aligned),
            upper_against_lower(run, aligned),
            ringing(run, aligned),
            *drift(run, aligned),
        ]
    return tuple(sorted((c for c in found if c is not None), key=lambda c: -c.size))
