# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Corrections that a board keeps for one channel (`firmware/PROTOCOL.md`), and how they follow from measured points."""

from dataclasses import astuple, dataclass

from hasel_driver.protocol.faults import LimitError

UNITY = 10_000
CALIBRATION_RANGES: dict[str, tuple[int, int]] = {
    "set_gain": (9_000, 11_000),
    "set_offset_v": (-300, 300),
    "read_gain": (9_000, 11_000),
    "read_offset_v": (-150, 150),
}
LEAST_POINTS, LEAST_SPAN_V = 3, 500.0


@dataclass(frozen=True)
class Calibration:
    """Gains in 1/10000, offsets in V; as it stands, no correction."""

    set_gain: int = UNITY
    set_offset_v: int = 0
    read_gain: int = UNITY
    read_offset_v: int = 0

    def set_point_v(self, volts: float) -> float:
        """What to ask of the converter [V] for `volts` on the muscle."""
        return max(0.0, volts * self.set_gain / UNITY + self.set_offset_v) if volts else 0.0

    def measured_v(self, volts: float) -> float:
        """Voltage of the muscle [V] when its monitor says `volts`."""
        return max(0.0, volts * self.read_gain / UNITY + self.read_offset_v)

    def words(self) -> str:
        """As in a command or reply."""
        return " ".join(map(str, astuple(self)))


@dataclass(frozen=True)
class Point:
    """One voltage [V], magnitudes."""

    asked_v: float
    monitor_v: float  # corrected as the board did it then
    probe_v: float


@dataclass(frozen=True)
class CalibrationTable:
    """Points of one channel, measured while the board used `present`."""

    points: tuple[Point, ...]
    present: Calibration

    def corrections(self) -> Calibration:
        """Least squares over the points, in place of `present`.

        Raises:
            LimitError: too few points, too close together, or corrections beyond what a sound supply needs.
        """
        import numpy as np  # the virtual board does without it

        asked_v, monitor_v, probe_v = np.array([astuple(point) for point in self.points]).reshape(-1, 3).T
        if len(probe_v) < LEAST_POINTS or np.ptp(probe_v) < LEAST_SPAN_V:
            raise LimitError(
                f"{len(probe_v)} points over {np.ptp(probe_v) if len(probe_v) else 0:.0f} V are too few:"
                f" at least {LEAST_POINTS} over {LEAST_SPAN_V:g} V were expected."
            )
        converter_v = asked_v * self.present.set_gain / UNITY + self.present.set_offset_v
        raw_v = (monitor_v - self.present.read_offset_v) * UNITY / self.present.read_gain
        set_gain, set_offset_v = np.polyfit(probe_v, converter_v, 1)
        read_gain, read_offset_v = np.polyfit(raw_v, probe_v, 1)
        found = (set_gain * UNITY, set_offset_v, read_gain * UNITY, read_offset_v)
        for value, (name, (low, high)) in zip(found, CALIBRATION_RANGES.items(), strict=True):
            if not low <= value <= high:
                raise LimitError(
                    f"{name} would be {value:.0f}, {low} to {high} was expected: check divider, probe and wiring."
                )
        return Calibration(*(round(value) for value in found))

    def __str__(self) -> str:
        rows = ["asked [V]  monitor [V]  probe [V]  output error [V]  monitor error [V]"]
        for point in self.points:
            rows.append(
                f"{point.asked_v:9.0f}  {point.monitor_v:11.0f}  {point.probe_v:9.0f}"
                f"  {point.probe_v - point.asked_v:+16.0f}  {point.monitor_v - point.probe_v:+17.0f}"
            )
        return "\n".join(rows)
