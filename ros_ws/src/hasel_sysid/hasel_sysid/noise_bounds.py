# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Upper bounds of the noise where no recording shows it alone."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from hasel_sim.drive.schedule import DriveSchedule
from scipy.optimize import minimize

from hasel_sysid.noise import FEWEST, LONGEST_CORRELATION, NoiseModel, estimate_noise
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.projection import orthonormal, regressors, unexplained_by
from hasel_sysid.residual_analysis.drive_cycle import drive_cycle

_ABOVE = 2.0
"""How many times the body's fastest frequency the band begins: what a wrong model moves wrongly lies below."""
_OF_THE_RATE = 0.99
"""Share of the power of the angular rate that lies below the body's fastest frequency."""


def known_noise(problem: Problem, fits: Sequence[Evaluation]) -> NoiseModel:
    """The noise where recordings show it alone, else its bound by these fits."""
    return problem.measured_noise or bounded_noise(fits)


def bounded_noise(fits: Sequence[Evaluation]) -> NoiseModel:
    """From what the best of these fits leaves, what differs between periods, and what is faster than the body moves."""
    best = min(fits, key=lambda e: e.sum_of_squares)
    columns = np.column_stack([best.jacobian, regressors(best)])
    looks = estimate_noise(
        unexplained_by(columns, best.residual), best.series, columns, "what the best set leaves"
    )
    others = [noise_between_periods(best), noise_above_the_band(best)]
    bounds = [b.standard_deviation for b in others if b] + [looks.standard_deviation]
    share = (min(bounds) / looks.standard_deviation) ** 2
    return replace(looks, white=share * looks.white, coloured=share * looks.coloured, upper_bound=True)


def noise_between_periods(evaluation: Evaluation) -> NoiseModel | None:
    """The noise, from the residual's differences between frames one period apart; None where no drive repeats.

    What a model misses in every period alike drops out. What it misses while the motion builds up does not, so this
    errs to the loud side only.
    """
    residual, columns, series = [], [], []
    for number, (simulation, _, used, here) in enumerate(evaluation.each_series()):
        lag = _frames_per_period(simulation.run.time[used], simulation.run.schedule)
        if lag is None or here.sum() < lag + FEWEST:
            continue
        residual.append(_differences(evaluation.residual[here], lag))
        columns.append(_differences(evaluation.jacobian[here], lag))
        series.append(np.full(len(residual[-1]), number))
    if not residual:
        return None
    return estimate_noise(
        np.concatenate(residual),
        np.concatenate(series),
        orthonormal(np.concatenate(columns)),
        "what differs between periods of the drive",
    )


def _frames_per_period(time: np.ndarray, schedule: DriveSchedule | None) -> int | None:
    cycle = drive_cycle(time, schedule.at(time)) if schedule is not None and len(time) > 1 else None
    return None if cycle is None else max(1, round(cycle.period / float(np.median(np.diff(time)))))


def _differences(series: np.ndarray, lag: int) -> np.ndarray:
    """Scaled so that independent noise keeps its variance."""
    return (series[lag:] - series[:-lag]) / np.sqrt(2.0)


def noise_above_the_band(evaluation: Evaluation) -> NoiseModel | None:
    """The largest noise that the residual's fast part allows; None where there is too little of it.

    White noise is seen as it is. Noise that neighbouring frames share is only seen by its fast end, so it is taken to
    be as slow as noise can be and the bound is then up to twice its power. Hann windows keep what moves slowly out.
    """
    lowest = _ABOVE * _fastest(evaluation)
    omega, power = [], []
    for frame_time, residual in _each(evaluation, evaluation.residual):
        frequency, spectrum = _spectrum(residual, frame_time)
        above = frequency > lowest
        omega.append(2 * np.pi * frequency[above] * frame_time)
        power.append(spectrum[above])
    angle, periodogram = np.concatenate(omega), np.concatenate(power)
    if len(angle) < FEWEST or not periodogram.mean() > 0:
        return None
    rho = LONGEST_CORRELATION
    shape = (1 - rho**2) / (1 - 2 * rho * np.cos(angle) + rho**2)
    level = float(np.log(periodogram.mean()))

    def negative_likelihood(logarithms: np.ndarray) -> float:
        expected = np.exp(logarithms[0]) + np.exp(logarithms[1]) * shape
        return float(np.sum(np.log(expected) + periodogram / expected))

    starts = ((level, level - 2), (level - 3, level + 2))
    bounds = [(level - 12, level + 1), (level - 12, level + 6)]
    best = min(
        (minimize(negative_likelihood, s, bounds=bounds, method="L-BFGS-B") for s in starts),
        key=lambda found: found.fun,
    )
    white, coloured = np.exp(best.x)
    return NoiseModel(float(white), float(coloured), rho, f"what is faster than {lowest:.3g} Hz", True)


def _fastest(evaluation: Evaluation) -> float:
    """The body's fastest frequency [Hz]: below it lies all but a hundredth of the simulated rate's power, in all runs,
    and the strongest frequency of the measured angle.
    """
    simulated = evaluation.simulated()
    found = 0.0
    for (frame_time, own), (_, measured) in zip(
        _each(evaluation, simulated), _each(evaluation, simulated + evaluation.residual), strict=True
    ):
        frequency, power = _spectrum(own, frame_time)
        rate = np.cumsum(power * frequency**2)
        if len(rate) and rate[-1] > 0:
            found = max(found, frequency[np.searchsorted(rate, _OF_THE_RATE * rate[-1])])
        frequency, power = _spectrum(measured, frame_time)
        if len(power):
            found = max(found, frequency[np.argmax(power)])
    return float(found)


def _each(evaluation: Evaluation, values: np.ndarray) -> list[tuple[float, np.ndarray]]:
    """Frame time [s] and values [frames] of every output of every run."""
    parts = []
    for simulation, _, used, here in evaluation.each_series():
        time = simulation.run.time[used]
        step = float(np.median(np.diff(time))) if len(time) > 1 else 1.0
        parts.append((step, values[here]))
    return parts


def _spectrum(series: np.ndarray, frame_time: float) -> tuple[np.ndarray, np.ndarray]:
    """Frequencies [Hz] and power per frequency (the variance of a frame, for white noise), both without frequency 0."""
    window = np.hanning(len(series))
    total = float(window @ window)
    if len(series) < 8 or total == 0:
        return np.zeros(0), np.zeros(0)
    power = np.abs(np.fft.rfft(window * (series - series.mean()))) ** 2 / total
    return np.fft.rfftfreq(len(series), frame_time)[1:], power[1:]
