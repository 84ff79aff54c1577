# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How fast and how long a body that is let go swings, against the simulation."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import curve_fit

from hasel_sysid.residual_analysis.component import Component, Kind
from hasel_sysid.residual_analysis.run_series import RunSeries


@dataclass(frozen=True)
class Swing:
    """offset + amplitude exp(-decay t) cos(2 pi frequency t + phase), t from the first frame."""

    frequency: float
    decay: float
    frequency_error: float
    decay_error: float
    parameters: np.ndarray

    @property
    def damping_ratio(self) -> float:
        """Decay relative to critical [1]."""
        return self.decay / np.hypot(self.decay, 2 * np.pi * self.frequency)


def swing_at(
    time: np.ndarray, offset: float, cosine: float, sine: float, frequency: float, decay: float
) -> np.ndarray:
    """The damped oscillation at times [s] [n] after the release."""
    angle = 2 * np.pi * frequency * time
    return offset + np.exp(-decay * time) * (cosine * np.cos(angle) + sine * np.sin(angle))


def fit_swing(time: np.ndarray, series: np.ndarray) -> Swing | None:
    """Fit one damped oscillation to a series [n] at times [s] [n]; None when it does not swing."""
    elapsed, centred = time - time[0], series - series.mean()
    if len(series) < 16 or np.ptp(series) == 0:
        return None
    even = np.linspace(0, elapsed[-1], len(elapsed))
    spectrum = np.abs(np.fft.rfft(np.interp(even, elapsed, centred) * np.hanning(len(even))))
    peak = int(np.argmax(spectrum[1:])) + 1
    start = [series.mean(), centred[0], 0.0, peak / elapsed[-1], 1.0 / elapsed[-1]]
    try:
        best, covariance = curve_fit(swing_at, elapsed, series, p0=start, maxfev=4000)
    except RuntimeError:
        return None
    if not np.all(np.isfinite(covariance)) or best[3] <= 0:
        return None
    left = series - swing_at(elapsed, *best)
    spread = np.sqrt(np.diag(covariance) * _correlation_time(left))
    return Swing(float(best[3]), float(best[4]), float(spread[3]), float(spread[4]), best)


def _correlation_time(series: np.ndarray) -> float:
    """Frames per independent value: 1 + 2 sum of the autocorrelation up to its first zero."""
    power = float(series @ series)
    if power == 0:
        return 1.0
    correlation = np.correlate(series, series, "full")[len(series) :] / power
    negative = np.flatnonzero(correlation <= 0)
    return 1.0 + 2.0 * float(correlation[: negative[0] if len(negative) else None].sum())


def free_swing(run: RunSeries) -> tuple[Component, ...]:
    """Relative difference of the frequency [1] and difference of the decay [1/s], measured against simulated."""
    measured, simulated = fit_swing(run.time, run.measured), fit_swing(run.time, run.simulated)
    if measured is None or simulated is None:
        return ()
    elapsed = run.time - run.time[0]

    def changed(index: int, value: float) -> float:
        parameters = simulated.parameters.copy()
        parameters[index] = value
        return float(np.std(swing_at(elapsed, *parameters) - swing_at(elapsed, *simulated.parameters)))

    ratio = measured.frequency / simulated.frequency
    frequency_error = ratio * np.hypot(
        measured.frequency_error / measured.frequency, simulated.frequency_error / simulated.frequency
    )
    return (
        Component(
            Kind.SWING_FREQUENCY,
            ratio - 1.0,
            float(frequency_error),
            "1",
            changed(3, measured.frequency),
            {"measured_hz": measured.frequency, "simulated_hz": simulated.frequency},
        ),
        Component(
            Kind.SWING_DECAY,
            measured.decay - simulated.decay,
            float(np.hypot(measured.decay_error, simulated.decay_error)),
            "1/s",
            changed(4, measured.decay),
            {
                "measured_damping_ratio": float(measured.damping_ratio),
                "simulated_damping_ratio": float(simulated.damping_ratio),
            },
        ),
    )
