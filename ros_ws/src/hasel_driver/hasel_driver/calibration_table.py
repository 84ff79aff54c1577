"""What a channel was asked for, what its monitor said and what a probe measured; and the corrections that follow."""

from dataclasses import dataclass

import numpy as np

from hasel_driver.calibration import CALIBRATION_RANGES, UNITY, Calibration
from hasel_driver.errors import LimitError

LEAST_POINTS, LEAST_SPAN_V = 3, 500.0


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
        asked_v, monitor_v, probe_v = (
            np.array([(point.asked_v, point.monitor_v, point.probe_v) for point in self.points])
            .reshape(-1, 3)
            .T
        )
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
