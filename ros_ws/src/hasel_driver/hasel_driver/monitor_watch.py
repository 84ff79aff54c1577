"""Whether one channel's measured voltage follows what was asked for: a blind monitor proves nothing."""

import math
from dataclasses import dataclass

from hasel_driver.ground import Ground
from hasel_driver.limits import MUSCLE_NAMES
from hasel_driver.mode import Mode
from hasel_driver.supply import Reading

LEAST_FOLLOWED_V = 400.0  # of what is asked for, below which a monitor tells too little
LOW_S = 0.2  # below half of what is asked for, or of the wrong sign, for so long
STUCK_S = 0.35  # at one value for so long, while what is asked for has changed by MOVED_V
STUCK_V, MOVED_V = 20.0, 500.0
FOLLOWED_SHARE = 0.85  # a monitor that is out by more is refused by `calibrate`, too
REVERSAL_S = 0.2  # dead times and discharge of a change of polarity
LONGEST_STEP_S = 0.05  # what lies between two reports further apart is not known


@dataclass
class MonitorWatch:
    """Fed with magnitudes, in the sign of what is asked for, while the source is connected; as in the firmware."""

    _low_s: float = 0.0
    _stuck_v: float = 0.0
    _anchor_v: float = 0.0  # asked for when the measured voltage moved last
    _risen_s: float = 0.0  # for which it should have risen
    _fallen_s: float = (
        0.0  # and fallen, without a break: a converter cannot sink, so a ripple need not be followed
    )

    def step(self, asked_v: float, reached_v: float, measured_v: float, duration_s: float) -> str | None:
        """What is wrong with `measured_v`, when `asked_v` was in force for `duration_s`; or None.

        reached_v: at least so much the output must have by now, through slew limit and reversals.
        """
        if reached_v >= LEAST_FOLLOWED_V:
            self._low_s = self._low_s + duration_s if measured_v < reached_v / 2 else 0.0
        if abs(measured_v - self._stuck_v) > STUCK_V:
            self._stuck_v, self._anchor_v = measured_v, asked_v
            self._risen_s = self._fallen_s = 0.0
        if asked_v >= self._anchor_v + MOVED_V and self._stuck_v <= FOLLOWED_SHARE * asked_v:
            self._risen_s += duration_s
        self._fallen_s = self._fallen_s + duration_s if asked_v <= self._anchor_v - MOVED_V else 0.0
        if self._low_s >= LOW_S:
            return f"{measured_v:.0f} V are measured where {asked_v:.0f} V are asked for"
        if max(self._risen_s, self._fallen_s) >= STUCK_S:
            return f"{measured_v:.0f} V are measured still, {self._anchor_v:.0f} V became {asked_v:.0f} V"
        return None


class OutputWatch:
    """Both channels of a supply, by its reports: what was asked for, as the slew limit lets it rise, and measured."""

    def __init__(self) -> None:
        self._time_s: float | None = None
        self.restart()

    def restart(self) -> None:
        """The output begins at 0 V again, as after the maximum was lowered."""
        self._watches = (MonitorWatch(), MonitorWatch())
        self._signs = [0, 0]
        self._reached_v = [0.0, 0.0]
        self._pauses_s = [0.0, 0.0]

    def take(self, reading: Reading, slew_v_per_ms: float) -> str | None:
        """What is wrong with the monitors by the reports so far."""
        last_s, self._time_s = self._time_s, reading.time_s
        duration_s = 0.0 if last_s is None else min(max(reading.time_s - last_s, 0.0), LONGEST_STEP_S)
        found = [
            self._step(channel, reading, slew_v_per_ms * 1e3 * duration_s, duration_s) for channel in range(2)
        ]
        return next((text for text in found if text), None)

    def _step(self, channel: int, reading: Reading, rise_v: float, duration_s: float) -> str | None:
        asked_v, measured_v = reading.commanded_v[channel], reading.measured_v[channel]
        sign = (asked_v > 0) - (asked_v < 0) if reading.mode is Mode.ACTIVE else 0
        if sign != self._signs[channel] or (reading.ground or Ground.NOT) is not Ground.NOT:
            self._signs[channel], self._reached_v[channel] = sign, 0.0
            self._pauses_s[channel] = REVERSAL_S
        if not sign or math.isnan(measured_v):
            return None
        self._pauses_s[channel] -= duration_s
        if self._pauses_s[channel] <= 0:
            self._reached_v[channel] = min(abs(asked_v), self._reached_v[channel] + rise_v)
        reached_v = self._reached_v[channel]
        wrong = self._watches[channel].step(abs(asked_v), reached_v, sign * measured_v, duration_s)
        return wrong and f"{MUSCLE_NAMES[channel]} muscle: {wrong}"
