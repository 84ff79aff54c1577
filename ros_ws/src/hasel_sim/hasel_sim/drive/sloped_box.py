"""The baseline muscle: an amplitude per voltage, approached at a limited rate (the seed paper's sloped box)."""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

LARGEST_ONSET = 0.8
"""Of the lowest level at which anything contracts: much nearer to it, an exponent would have to be absurd."""


def target_contraction(
    voltage: np.ndarray,
    levels: np.ndarray,
    amplitudes: np.ndarray,
    threshold: float | None = None,
    between: str = "cubic",
) -> np.ndarray:
    """Contraction [1] aimed at for a voltage [V] of any shape, from the amplitudes at known levels [V].

    Monotone between the levels: cubic (PCHIP; Fritsch and Carlson 1980), or "power", a power of the voltage from each
    to the next. Below the lowest a power of the voltage above a threshold [V] that goes on as steeply as it is met;
    above the highest, on with the slope it has there. Without a threshold, that of the lowest three; where fewer are
    known, a curve from 0 V.
    """
    if len(levels) == 0:
        return np.zeros_like(voltage, dtype=float)
    curve = _curve(tuple(levels), tuple(amplitudes), threshold, between)
    magnitude = np.abs(voltage)
    inside = curve.within(np.clip(magnitude, curve.lowest, levels[-1]))
    beyond = np.maximum(magnitude - levels[-1], 0.0) * curve.last_slope
    if curve.lowest == 0.0:
        return inside + beyond
    share = np.clip((magnitude - curve.threshold) / (curve.lowest - curve.threshold), 0.0, 1.0)
    return inside * share**curve.exponent + beyond


def onset(levels: np.ndarray, amplitudes: np.ndarray, threshold: float | None = None) -> float:
    """Voltage [V] up to which the contraction aimed at is nothing; 0 where there is none."""
    return _curve(tuple(levels), tuple(amplitudes), threshold, "cubic").threshold if len(levels) else 0.0


class _Curve(NamedTuple):
    """What is known of the amplitudes once and for all: below `lowest` [V] the onset, above it what lies between."""

    within: Callable[[np.ndarray], np.ndarray]
    lowest: float
    last_slope: float
    threshold: float
    exponent: float


@lru_cache(maxsize=64)
def _curve(
    levels: tuple[float, ...], amplitudes: tuple[float, ...], threshold: float | None, between: str
) -> _Curve:
    """The running simulation asks for the same curve at every step."""
    if threshold is None and len(levels) < 3:
        levels, amplitudes = (0.0, *levels), (0.0, *amplitudes)
    lowest = levels[0]
    if lowest == 0.0:
        below = 0.0, 1.0
    elif threshold is None:
        below = _onset(np.array(levels[:3]), np.array(amplitudes[:3]))
    else:
        below = threshold, 1.0
    if len(levels) == 1:
        levels, amplitudes = (below[0], lowest), (0.0, *amplitudes)
    powers = between == "power" and min(levels[0], *amplitudes) > 0.0
    within = PiecewisePower(levels, amplitudes) if powers else PchipInterpolator(levels, amplitudes)
    if threshold is not None and lowest > 0.0:
        below = threshold, _exponent_at(lowest, float(within(lowest)), float(within(lowest, 1)), threshold)
    return _Curve(within, lowest, float(within(levels[-1], 1)), *below)


def _exponent_at(level: float, amplitude: float, slope: float, threshold: float) -> float:
    """Of a power of the voltage [V] above a threshold that meets an amplitude with this slope [1/V]."""
    return slope * (level - threshold) / amplitude if amplitude > 0.0 and slope > 0.0 else 1.0


class PiecewisePower:
    """A power of the level from each known one to the next, all positive: straight lines of logarithms."""

    def __init__(self, levels: Sequence[float], amplitudes: Sequence[float]) -> None:
        self._levels, self._amplitudes = np.log(levels), np.log(amplitudes)
        self._powers = np.diff(self._amplitudes) / np.diff(self._levels)

    def __call__(self, level: np.ndarray, order: int = 0) -> np.ndarray:
        """Amplitude at levels of any shape, or with order 1 its slope there."""
        at = np.log(level)
        value = np.exp(np.interp(at, self._levels, self._amplitudes))
        if order == 0:
            return value
        piece = np.clip(np.searchsorted(self._levels, at, side="right") - 1, 0, len(self._powers) - 1)
        return value * self._powers[piece] / level


def _onset(levels: np.ndarray, amplitudes: np.ndarray) -> tuple[float, float]:
    """Threshold [V] and exponent of a = c (V - threshold)^exponent through three amplitudes.

    A pouch zips only above a threshold voltage; a drive effect that lets the voltage sweep makes this visible. No
    threshold where the amplitudes rise as V^exponent or more steeply; at most `LARGEST_ONSET` of the lowest level.
    """
    growth = np.diff(np.log(np.maximum(amplitudes, 1e-9)))
    if growth[0] <= 0.0:
        return 0.0, 1.0

    def excess(threshold: float) -> float:
        spans = np.diff(np.log(levels - threshold))
        return float(spans[0] * growth[1] - spans[1] * growth[0])

    largest = LARGEST_ONSET * levels[0]
    if excess(0.0) >= 0.0:
        threshold = 0.0
    elif excess(largest) <= 0.0:
        threshold = largest
    else:
        threshold = brentq(excess, 0.0, largest, xtol=1e-9, rtol=1e-14)
    return threshold, float(growth[0] / np.diff(np.log(levels[:2] - threshold))[0])


@njit(cache=True)
def limit_rate(time: np.ndarray, target: np.ndarray, slope: float) -> np.ndarray:
    """Follow a target [n, 2] at times [s] [n], starting from 0, at no more than slope [1/s] up or down.

    Exact for a target that changes steadily between its times: where it is met in between, the way goes on from there.
    """
    out = np.empty_like(target)
    for muscle in range(target.shape[1]):
        value, before = 0.0, 0.0
        for i in range(target.shape[0]):
            left, after = time[i] - time[max(i - 1, 0)], target[i, muscle]
            if left > 0.0:
                steepness = (after - before) / left
                gap = before - value
                towards = slope if gap > 0.0 else -slope
                closing = abs(towards - steepness) if (towards - steepness) * gap > 0.0 else 0.0
                if abs(gap) >= closing * left and gap != 0.0:
                    value += towards * left
                else:
                    met = abs(gap) / closing if gap != 0.0 else 0.0
                    on_target = before + steepness * met
                    limited = min(max(steepness, -slope), slope)
                    value = on_target + limited * (left - met)
            before = after
            out[i, muscle] = value
    return out
