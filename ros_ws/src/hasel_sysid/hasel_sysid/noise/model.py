"""The noise of the measured angle: white, plus a part that neighbouring frames share."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import matmul_toeplitz
from scipy.optimize import minimize
from scipy.signal import lfilter

_SLOW_SHARE = 3.0 / 120.0
"""Frequencies below this share of the frame rate (3 Hz at 120 frames/s) are the body's, not the noise's."""
LONGEST_CORRELATION = 0.95
"""Largest correlation between neighbouring frames that still counts as noise."""

FEWEST = 16
"""Frames, or frequencies, that tell a spectrum."""


@dataclass(frozen=True)
class NoiseModel:
    """Autocovariance white (lag 0) + coloured correlation^lag, lag in frames; the variances are of sin theta.

    source: where the numbers come from, in words; upper_bound: whether the noise may be less, because nothing in the
    recordings shows it alone.
    """

    white: float
    coloured: float
    correlation: float
    source: str = "what the best model leaves"
    upper_bound: bool = False

    @property
    def standard_deviation(self) -> float:
        """Of one frame."""
        return float(np.sqrt(self.white + self.coloured))

    @property
    def mean_absolute(self) -> float:
        """Mean |noise|, what mean |Δ sin θ| would be for a perfect model."""
        return float(np.sqrt(2 / np.pi) * self.standard_deviation)

    def covariance_product(self, columns: np.ndarray, runs: np.ndarray) -> np.ndarray:
        """Covariance matrix times columns [frames, n]; runs [frames] are independent of each other."""
        out = np.empty_like(columns)
        for run in np.unique(runs):
            here = runs == run
            first = self.coloured * self.correlation ** np.arange(here.sum())
            first[0] += self.white
            out[here] = matmul_toeplitz(first, columns[here])
        return out

    def sample(
        self, runs: np.ndarray, count: int, generator: np.random.Generator, free_offset: bool = True
    ) -> np.ndarray:
        """Draw noise series, [frames, count]; free_offset: the mean of every run removed."""
        out = np.empty((len(runs), count))
        for run in np.unique(runs):
            here = runs == run
            n = here.sum()
            drive = generator.standard_normal((n, count))
            drive[1:] *= np.sqrt(1 - self.correlation**2)
            slow = np.sqrt(self.coloured) * lfilter([1.0], [1.0, -self.correlation], drive, axis=0)
            series = slow + np.sqrt(self.white) * generator.standard_normal((n, count))
            out[here] = series - series.mean(axis=0) if free_offset else series
        return out

    def __str__(self) -> str:
        share = self.coloured / max(self.white + self.coloured, 1e-300)
        memory = -1 / np.log(min(max(self.correlation, 1e-9), 1 - 1e-9))
        colour = f", {share:.0%} of its power shared over {memory:.0f} frames" if share > 0.005 else ", white"
        if self.upper_bound:
            return (
                f"noise of at most {self.standard_deviation:.2g} rms{colour} (from {self.source}; no frames at rest "
                "and no repeated runs show it alone: give it with --noise)"
            )
        return f"noise of {self.standard_deviation:.2g} rms{colour} (from {self.source})"

    def with_discrepancy(self, rms: float) -> "NoiseModel":
        """The noise and, as slow as noise can be, an error of the model of so much rms."""
        more = rms**2
        coloured = self.coloured + more
        memory = (self.coloured * self.correlation + more * LONGEST_CORRELATION) / max(coloured, 1e-300)
        return replace(self, coloured=coloured, correlation=float(memory))


def _logit(share: float) -> float:
    return float(np.log(share / (1 - share)))


def estimate_noise(residual: np.ndarray, runs: np.ndarray, fitted: np.ndarray, source: str) -> NoiseModel:
    """Fit the noise to what a model leaves, by Whittle's likelihood of the periodograms of all runs.

    Only frequencies above `_SLOW_SHARE` of the frame rate count, where a body of a few hertz leaves little; the slow
    part follows from the correlation found there, so that what a model misses is not taken for noise. No more is
    called noise than is there.

    residual [frames]; fitted [frames, n]: directions already taken out of it, which lack the noise's power.
    """
    basis = np.linalg.qr(fitted)[0] if fitted.shape[1] else fitted
    frequency, power, left = [], [], []
    for run in np.unique(runs):
        here = runs == run
        n = here.sum()
        if n < FEWEST:
            continue
        first = max(1, int(np.ceil(n * _SLOW_SHARE)))
        transform = np.fft.rfft(residual[here])[first:]
        frequency.append(2 * np.pi * np.arange(first, first + len(transform)) / n)
        power.append(np.abs(transform) ** 2 / n)
        taken = (np.abs(np.fft.rfft(basis[here], axis=0)[first:]) ** 2).sum(axis=1) / n
        left.append(np.clip(1 - taken, 0.05, 1.0))
    if not frequency:
        return NoiseModel(float(np.var(residual)), 0.0, 0.5, source)
    omega, periodogram, remaining = (np.concatenate(part) for part in (frequency, power, left))
    level = np.log(max(periodogram.mean(), 1e-30))

    def negative_likelihood(parameters: np.ndarray) -> float:
        white, coloured, rho = np.exp(parameters[0]), np.exp(parameters[1]), 1 / (1 + np.exp(-parameters[2]))
        spectrum = white + coloured * (1 - rho**2) / (1 - 2 * rho * np.cos(omega) + rho**2)
        expected = spectrum * remaining
        return float(np.sum(np.log(expected) + periodogram / expected))

    bounds = [(level - 8, level + 3), (level - 8, level + 6), (-1.0, _logit(LONGEST_CORRELATION))]
    starts = ([level, level - 2, 2.0], [level - 2, level, 2.0], [level, level - 5, 0.0])
    best = min(
        (minimize(negative_likelihood, s, bounds=bounds, method="L-BFGS-B") for s in starts),
        key=lambda r: r.fun,
    )
    white, coloured, rho = np.exp(best.x[0]), np.exp(best.x[1]), 1 / (1 + np.exp(-best.x[2]))
    most = residual @ residual / max(len(residual) - fitted.shape[1], 1)
    return NoiseModel(
        float(min(white, most)), float(np.clip(most - white, 0.0, coloured)), float(rho), source
    )


def allowed_noise(noise: NoiseModel, discrepancy: float) -> NoiseModel:
    """What a right model may leave: the noise and the one discrepancy (rms) that is allowed for.

    An upper bound of the noise, which holds some of it already, is only raised where it lies below that discrepancy.
    """
    if not noise.upper_bound:
        return noise.with_discrepancy(discrepancy)
    missing = discrepancy**2 - noise.standard_deviation**2
    return noise.with_discrepancy(float(np.sqrt(missing))) if missing > 0 else noise
