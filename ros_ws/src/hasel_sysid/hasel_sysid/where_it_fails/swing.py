"""How fast and how long a body that is let go swings: one damped oscillation, fitted to a series."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import curve_fit


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


def swing_at(time: np.ndarray, offset, cosine, sine, frequency, decay) -> np.ndarray:
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
