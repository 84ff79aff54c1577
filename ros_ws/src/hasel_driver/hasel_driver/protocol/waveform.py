# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Voltage waveforms of two antagonistic muscles: as the board generates them (`firmware/PROTOCOL.md`), or in rows."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar

from hasel_driver.protocol.faults import LimitError
from hasel_driver.protocol.limits import Voltages

if TYPE_CHECKING:  # the safety process does without it, but for the arrays it is sent
    import numpy as np

SHAPES: dict[str, Callable[[float], float]] = {
    "box": lambda s: 1.0,
    "ramp": lambda s: s,
    "sine": lambda s: math.sin(math.pi * s),
    "triangle": lambda s: 1.0 - abs(2.0 * s - 1.0),
}
LONGEST_S = 3600.0
POLARITIES = ("positive", "negative", "alternating")
# Delay of the upper and lower muscle [periods]; None: not driven.
MUSCLES: dict[str, tuple[float | None, float | None]] = {
    "both": (0.0, 0.5),
    "upper": (0.0, None),
    "lower": (None, 0.0),
    "lower_first": (0.5, 0.0),
}


@dataclass(frozen=True)
class Waveform:
    """A periodic drive of the two muscles.

    `voltage_v` is the peak [V], `frequency_hz` [Hz], `duty` the share of its half period in which a muscle is
    driven (1: one muscle takes over from the other).
    """

    shape: str
    voltage_v: float
    frequency_hz: float
    periods: int
    duty: float = 1.0
    polarity: str = "positive"
    muscles: str = "both"

    RANGES: ClassVar[dict[str, tuple[float, float]]] = {
        "voltage_v": (0.0, 10_000.0),
        "frequency_hz": (0.01, 50.0),
        "periods": (1, 60_000),
        "duty": (0.001, 1.0),
    }

    def __post_init__(self) -> None:
        for name, (low, high) in self.RANGES.items():
            value = getattr(self, name)
            if not low <= value <= high:
                raise LimitError(f"{name} is {value}, {low:g} to {high:g} was expected.")
        for name, choices in (("shape", SHAPES), ("polarity", POLARITIES), ("muscles", MUSCLES)):
            value = getattr(self, name)
            if value not in choices:
                raise LimitError(f"{name} is {value!r}, one of {', '.join(choices)} was expected.")

    def metadata(self) -> dict[str, str]:
        """Header lines of the recording."""
        return {
            "waveform": self.shape,
            "voltage_v": f"{self.voltage_v:g}",
            "frequency_hz": f"{self.frequency_hz:g}",
            "periods": str(self.periods),
            "duty": f"{self.duty:g}",
            "polarity": self.polarity,
            "muscles": self.muscles,
        }

    @property
    def duration_s(self) -> float:
        """Time from start to end [s]."""
        return self.periods / self.frequency_hz

    def voltage(self, time_s: float) -> tuple[float, float]:
        """Voltage of the upper and lower muscle [V] at `time_s` after the start; 0 outside the waveform."""
        if not 0.0 <= time_s < self.duration_s:
            return 0.0, 0.0
        phase = time_s * self.frequency_hz
        upper, lower = (self._muscle_voltage(phase, delay) for delay in MUSCLES[self.muscles])
        return upper, lower

    def _muscle_voltage(self, phase: float, delay: float | None) -> float:
        if delay is None or phase < delay:
            return 0.0
        cycle, position = divmod(phase - delay, 1.0)
        driven = 0.5 * self.duty
        if position >= driven:
            return 0.0
        return self._sign(int(cycle)) * self.voltage_v * SHAPES[self.shape](position / driven)

    def _sign(self, cycle: int) -> int:
        if self.polarity == "alternating":
            return 1 if cycle % 2 == 0 else -1
        return 1 if self.polarity == "positive" else -1


@dataclass(frozen=True)
class FileWaveform:
    """Rows [n] of time [s], from 0, and voltages [n, 2] [V]; the drive ends with the last row's time."""

    path: Path
    time_s: "np.ndarray"
    voltages_v: "np.ndarray"

    @property
    def duration_s(self) -> float:
        """Time from the first row to the last [s]."""
        return float(self.time_s[-1])

    @property
    def voltage_v(self) -> float:
        """Highest magnitude [V]."""
        return float(abs(self.voltages_v).max())

    @property
    def polarity(self) -> str:
        """`positive` where no voltage is below 0, else `mixed`."""
        return "positive" if (self.voltages_v >= 0).all() else "mixed"

    def row(self, time_s: float) -> int:
        """The number of the row that holds at `time_s` after the start; the last one's from the end on."""
        return int(self.time_s.searchsorted(time_s, side="right")) - 1

    def changes_between(self, first: int, last: int) -> list[float]:
        """Times [s] of the rows between these two that ask for another voltage than the row before them."""
        if last - first < 2:
            return []
        changed = (self.voltages_v[first + 1 : last] != self.voltages_v[first : last - 1]).any(axis=1)
        return self.time_s[first + 1 : last][changed].tolist()

    def voltage(self, time_s: float) -> Voltages:
        """Voltage of the upper and lower muscle [V] at `time_s` after the start; 0 outside the drive."""
        if not 0.0 <= time_s < self.duration_s:
            return 0.0, 0.0
        upper, lower = self.voltages_v[self.row(time_s)]
        return float(upper), float(lower)

    def metadata(self) -> dict[str, str]:
        """Header lines of the recording."""
        return {"waveform": "file", "waveform_file": str(self.path), "voltage_v": f"{self.voltage_v:g}"}
