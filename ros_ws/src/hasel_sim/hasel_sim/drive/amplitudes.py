# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The baseline muscle: an amplitude per level of the drive, approached at a limited rate (the paper's sloped box)."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numba import njit
from scipy.interpolate import PchipInterpolator

if TYPE_CHECKING:
    from hasel_sim.model.sections import Channel

LARGEST_ONSET = 0.8
"""Of the lowest level at which anything contracts: much nearer to it, an exponent would have to be absurd."""


@dataclass(frozen=True)
class AmplitudeTable:
    """Channels that contract alike at equal levels, and how their amplitudes are called.

    `amplitude_<level>` for a voltage [V], `amplitude_<level>_pa` for a pressure and so on; with the channel's name
    before the level for one that has amplitudes of its own. largest: their upper bound.
    """

    channels: tuple[str, ...]
    unit: str
    largest: float
    own: str = ""

    @property
    def _prefix(self) -> str:
        return f"amplitude_{self.own}_" if self.own else "amplitude_"

    @property
    def _suffix(self) -> str:
        return "" if self.unit == "V" else f"_{self.unit.lower()}"

    def name(self, level: float) -> str:
        """The parameter that holds the contraction at a level."""
        return f"{self._prefix}{level:g}{self._suffix}"

    @property
    def onset(self) -> str:
        """The parameter up to which a drive contracts nothing, in the unit of the levels: `onset`, `onset_pa` ..."""
        own = f"_{self.own}" if self.own else ""
        return f"onset{own}{self._suffix}"

    def level(self, name: str) -> float | None:
        """The level that a parameter's name speaks of; None where it is not one of this table."""
        if not (name.startswith(self._prefix) and name.endswith(self._suffix)):
            return None
        try:
            level = float(name[len(self._prefix) : len(name) - len(self._suffix)])
        except ValueError:
            return None
        return level if level > 0 and name == self.name(level) else None

    def meant_by(self, name: str) -> str | None:
        """How a name that only begins as those of this table should be written; None where it does not."""
        if not name.startswith(self._prefix):
            return None
        try:
            level = float(name[len(self._prefix) :].removesuffix(self._suffix))
        except ValueError:
            level = 0.0
        if level > 0:
            return f"'{self.name(level)}'"
        return f"'{self._prefix}<level>{self._suffix}' with the level in {self.unit}, such as '{self.name(5500)}'"

    def levels(self, names: Iterable[str]) -> np.ndarray:
        """All levels that these parameter names speak of, ascending."""
        found = [self.level(name) for name in names]
        return np.sort(np.array([level for level in found if level is not None]))


def amplitude_tables(channels: tuple["Channel", ...]) -> tuple[AmplitudeTable, ...]:
    """One table per quantity, and one per channel that has amplitudes of its own."""
    shared: dict[str, list[Channel]] = {}
    tables = []
    for channel in channels:
        if channel.own_amplitudes:
            tables.append(
                AmplitudeTable((channel.name,), channel.unit, channel.largest_contraction, channel.name)
            )
        else:
            shared.setdefault(channel.unit, []).append(channel)
    alike = [
        AmplitudeTable(tuple(c.name for c in group), unit, max(c.largest_contraction for c in group))
        for unit, group in shared.items()
    ]
    return (*alike, *tables)


def target_contraction(
    voltage: np.ndarray,
    levels: np.ndarray,
    amplitudes: np.ndarray,
    onset: float = 0.0,
    between: str = "cubic",
) -> np.ndarray:
    """Contraction [1] aimed at for a voltage [V] of any shape, from the amplitudes at known levels [V].

    Monotone between the levels: cubic (PCHIP; Fritsch and Carlson 1980), or "power", a power of the voltage from each
    to the next. Below the lowest a power of the voltage above the onset [V], as steep as the curve that it meets; above
    the highest, on with the slope it has there.
    """
    if len(levels) == 0:
        return np.zeros_like(voltage, dtype=float)
    curve = _curve(tuple(levels), tuple(amplitudes), onset, between)
    lowest, highest = levels[0], levels[-1]
    magnitude = np.abs(voltage)
    inside = curve.within(np.clip(magnitude, lowest, highest))
    share = np.clip((magnitude - onset) / (lowest - onset), 0.0, 1.0)
    return inside * share**curve.exponent + np.maximum(magnitude - highest, 0.0) * curve.last_slope


class _Curve(NamedTuple):
    """What is known of the amplitudes once and for all: between the levels, above the highest, below the lowest."""

    within: Callable[[np.ndarray], np.ndarray]
    last_slope: float
    exponent: float


@lru_cache(maxsize=64)
def _curve(levels: tuple[float, ...], amplitudes: tuple[float, ...], onset: float, between: str) -> _Curve:
    """The running simulation asks for the same curve at every step."""
    lowest = levels[0]
    if len(levels) == 1:
        levels, amplitudes = (onset, lowest), (0.0, *amplitudes)
    powers = between == "power" and min(levels[0], *amplitudes) > 0.0
    within = PiecewisePower(levels, amplitudes) if powers else PchipInterpolator(levels, amplitudes)
    amplitude, slope = float(within(lowest)), float(within(lowest, 1))
    rises = amplitude > 0.0 and slope > 0.0
    exponent = slope * (lowest - onset) / amplitude if rises else 1.0
    return _Curve(within, float(within(levels[-1], 1)), exponent)


class PiecewisePower:
    """A power of the level from each known one to the next, all positive: straight lines of logarithms."""

    def __init__(self, levels: Sequence[float], amplitudes: Sequence[float]) -> None:
        self._levels, self._amplitudes = np.log(levels), np.log(amplitudes)
        self._powers = np.diff(self._amplitudes) / np.diff(self._levels)

    def __call__(self, level: np.ndarray | float, order: int = 0) -> np.ndarray:
        """Amplitude at levels of any shape, or with order 1 its slope there."""
        at = np.log(level)
        value = np.exp(np.interp(at, self._levels, self._amplitudes))
        if order == 0:
            return value
        piece = np.clip(np.searchsorted(self._levels, at, side="right") - 1, 0, len(self._powers) - 1)
        return value * self._powers[piece] / level


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
