# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The noise of the measured angle: white, plus a part that neighbouring frames share.

Its model, and its size where recordings show it alone: given, between repeated runs, or at rest.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from hasel_sim.run import Run
from scipy.linalg import matmul_toeplitz
from scipy.optimize import minimize
from scipy.signal import lfilter
from scipy.stats import median_abs_deviation

from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment

_SLOW_SHARE = 3.0 / 120.0
"""Frequencies below this share of the frame rate (3 Hz at 120 frames/s) are the body's, not the noise's."""
LONGEST_CORRELATION = 0.95
"""Largest correlation between neighbouring frames that still counts as noise."""

FEWEST = 16
"""Frames, or frequencies, that tell a spectrum."""
_SEED_SHARE = 1 / 3
"""Share of the frames before the start from which the scatter at rest is first read."""
_STILL = 6.0
"""Robust standard deviations beyond which a frame has moved."""
_MUCH_LESS = 0.1
"""At rest a body scatters by less than this share of what it moves by; a stretch that does not is not at rest."""


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


def measured_noise(experiments: Sequence[Experiment]) -> NoiseModel | None:
    """The noise between repeated runs, else at rest; None where these recordings show neither."""
    repeats = differences_of_repeats(experiments)
    if repeats:
        return _of(repeats, f"differences between {len(repeats)} pair(s) of repeated runs")
    rests = rest_stretches(experiments)
    frames = sum(map(len, rests))
    return _of(rests, f"{frames} frames at rest") if rests else None


def given_noise(standard_deviation: float) -> NoiseModel:
    """White noise of a known standard deviation of sin theta. Raises SysidError unless it is positive."""
    if not (np.isfinite(standard_deviation) and standard_deviation > 0):
        raise SysidError(
            f"the noise is given as {standard_deviation:g}; expected a standard deviation of sin θ above 0, "
            "such as 0.003"
        )
    return NoiseModel(standard_deviation**2, 0.0, 0.5, "as given")


def _of(stretches: Sequence[np.ndarray], source: str) -> NoiseModel:
    runs = np.repeat(np.arange(len(stretches)), [len(s) for s in stretches])
    means = (runs[:, None] == np.arange(len(stretches))).astype(float)
    return estimate_noise(np.concatenate(stretches), runs, means, source)


def differences_of_repeats(experiments: Sequence[Experiment]) -> list[np.ndarray]:
    """Differences [frames] of runs with the same frames, drive and start, scaled to the noise of one of them.

    The mean of each is removed, as every series' offset is. Of three repeats the third is left out.
    """
    found, rest = [], list(experiments)
    while rest:
        one = rest.pop(0)
        twin = next((other for other in rest if _same(one.run, other.run)), None)
        if twin is None:
            continue
        rest.remove(twin)
        for difference in ((one.outputs - twin.outputs) / np.sqrt(2.0)).T:
            seen = difference[np.isfinite(difference)]
            if len(seen) >= FEWEST and np.ptp(seen) > 0:
                found.append(seen - seen.mean())
    return found


def _same(one: Run, other: Run) -> bool:
    start = (one.initial_state, one.initial_load_factor, one.initial_time)
    if start != (other.initial_state, other.initial_load_factor, other.initial_time):
        return False
    if len(one.time) != len(other.time) or not np.allclose(one.time, other.time, atol=1e-6):
        return False
    first, second = one.schedule, other.schedule
    if first is None or second is None:
        return first is second
    return (
        first.signal.shape == second.signal.shape
        and np.allclose(first.time, second.time, atol=1e-6)
        and np.allclose(first.signal, second.signal)
    )


def rest_stretches(experiments: Sequence[Experiment]) -> list[np.ndarray]:
    """Every measured output [frames] while the body rests at the beginning of each run, the stretch's mean removed.

    Series without at least 16 such frames are left out.
    """
    return [stretch for e in experiments for one in e.outputs.T if (stretch := _at_rest(e, one)) is not None]


def _at_rest(experiment: Experiment, series: np.ndarray) -> np.ndarray | None:
    measured = np.isfinite(series)
    if not measured.any():
        return None
    before = measured & (experiment.run.time < _start(experiment))
    early, motion = series[before], float(np.std(series[measured]))
    count = _still_frames(early)
    if count < FEWEST:
        return None
    stretch = early[:count] - early[:count].mean()
    scatter = float(np.std(stretch))
    return stretch if 0 < scatter < _MUCH_LESS * motion else None


def _start(experiment: Experiment) -> float:
    """When the body may begin to move [s]: at the first voltage, or when it is let go."""
    run = experiment.run
    if run.schedule is None:
        return run.start
    on = np.flatnonzero(np.any(run.schedule.signal != 0, axis=1))
    return float(run.schedule.time[on[0]]) if len(on) else float("inf")


def _still_frames(series: np.ndarray) -> int:
    """How many frames from the first on stay where the body rested."""
    if len(series) < FEWEST:
        return 0
    seed = series[: max(FEWEST // 2, int(_SEED_SHARE * len(series)))]
    centre = np.median(seed)
    spread = median_abs_deviation(seed, scale="normal")
    moved = np.flatnonzero(np.abs(series - centre) > _STILL * spread)
    return int(moved[0]) if len(moved) else len(series)
