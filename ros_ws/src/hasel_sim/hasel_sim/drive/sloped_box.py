"""The baseline muscle: an amplitude per voltage, approached at a limited rate (the seed paper's sloped box)."""

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numba import njit
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq


def target_contraction(voltage: np.ndarray, levels: np.ndarray, amplitudes: np.ndarray) -> np.ndarray:
    """Contraction [1] aimed at for a voltage [V] of any shape, from the amplitudes at known levels [V].

    Monotone between the levels (PCHIP; Fritsch and Carlson 1980); below the lowest, `_onset` of the lowest three, or a
    straight line from 0 V where fewer are known; above the highest, on with the slope it has there.
    """
    if len(levels) == 0:
        return np.zeros_like(voltage, dtype=float)
    curve = _curve(tuple(levels), tuple(amplitudes))
    magnitude = np.abs(voltage)
    inside = curve.pchip(np.clip(magnitude, curve.lowest, levels[-1]))
    beyond = np.maximum(magnitude - levels[-1], 0.0) * curve.last_slope
    if curve.lowest == 0.0:
        return inside + beyond
    share = np.clip((magnitude - curve.threshold) / (curve.lowest - curve.threshold), 0.0, 1.0)
    return inside * share**curve.exponent + beyond


def onset(levels: np.ndarray, amplitudes: np.ndarray) -> float:
    """Voltage [V] up to which the contraction aimed at is nothing; 0 where there is none."""
    return _curve(tuple(levels), tuple(amplitudes)).threshold if len(levels) else 0.0


class _Curve(NamedTuple):
    """What is known of the amplitudes once and for all: below `lowest` [V] the onset, above it the spline."""

    pchip: PchipInterpolator
    lowest: float
    last_slope: float
    threshold: float
    exponent: float


@lru_cache(maxsize=64)
def _curve(levels: tuple[float, ...], amplitudes: tuple[float, ...]) -> _Curve:
    """The running simulation asks for the same curve at every step."""
    if len(levels) < 3:
        levels, amplitudes = (0.0, *levels), (0.0, *amplitudes)
    pchip = PchipInterpolator(levels, amplitudes)
    onset = _onset(np.array(levels[:3]), np.array(amplitudes[:3])) if levels[0] > 0.0 else (0.0, 1.0)
    return _Curve(pchip, levels[0], float(pchip(levels[-1], 1)), *onset)


def _onset(levels: np.ndarray, amplitudes: np.ndarray) -> tuple[float, float]:
    """Threshold [V] and exponent of a = c (V - threshold)^exponent through three amplitudes.

    A pouch zips only above a threshold voltage; a drive effect that lets the voltage sweep makes this visible. No
    threshold where the amplitudes rise as V^exponent or more steeply; at most 0.8 of the lowest level.
    """
    growth = np.diff(np.log(np.maximum(amplitudes, 1e-9)))
    if growth[0] <= 0.0:
        return 0.0, 1.0

    def excess(threshold: float) -> float:
        spans = np.diff(np.log(levels - threshold))
        return float(spans[0] * growth[1] - spans[1] * growth[0])

    largest = 0.8 * levels[0]
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
