# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Box voltages of two muscles that take turns."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.run import Run

FRAMES_PER_SECOND = 120.0


@dataclass(frozen=True, order=True)
class Boxes:
    """The first channel at one voltage [V], then the second at another, each for `duty` of its half of the period.

    phase: when the second starts, as a share of the period; frequency [Hz].
    """

    first: float
    second: float
    frequency: float
    duty: float = 1.0
    phase: float = 0.5

    def __str__(self) -> str:
        equal = self.first == self.second
        volts = f"{self.first:g} V" if equal else f"{self.first:g} and {self.second:g} V"
        return f"{volts} at {self.frequency:g} Hz"

    def schedule(self, duration: float, channels: tuple[str, ...]) -> DriveSchedule:
        """The drive of both channels over a duration [s]."""
        events: list[tuple[float, int, float]] = []
        for period in range(int(np.ceil(duration * self.frequency))):
            for muscle, (voltage, start) in enumerate(((self.first, 0.0), (self.second, self.phase))):
                on = (period + start) / self.frequency
                events += [(on, muscle, voltage), (on + 0.5 * self.duty / self.frequency, muscle, 0.0)]
        # where one box of a muscle ends as its next begins, the beginning is to be the last word
        events.sort(key=lambda event: (round(event[0], 12), event[2] != 0.0))
        state, rows = np.zeros(2), {}
        for time, muscle, voltage in events:
            state[muscle] = voltage
            rows[round(time, 12)] = state.copy()
        return DriveSchedule(np.array(list(rows)), np.array(list(rows.values())), channels)

    def run(self, model: Model, duration: float) -> Run:
        """A run of that drive from rest, with frames at 120 Hz.

        Raises SimulationError for a body that is not driven by two voltages, or a run of less than four periods.
        """
        if len(model.channels) != 2 or any(c.quantity != "voltage" for c in model.description.channels):
            driven = ", ".join(f"{c.name} ({c.quantity})" for c in model.description.channels)
            raise SimulationError(
                f"model '{model.name}' is driven by {driven or 'nothing'}; expected two voltages that take turns: "
                "choose another model"
            )
        if duration * self.frequency < 4.0:
            raise SimulationError(
                f"{duration:g} s hold {duration * self.frequency:.3g} periods of {self.frequency:g} Hz; expected at "
                "least 4, to see how it swims once it has set off: swim longer or faster"
            )
        frames = np.arange(round(duration * FRAMES_PER_SECOND) + 1) / FRAMES_PER_SECOND
        return Run(str(self), frames, self.schedule(duration, model.channels))


def waveform_rows(drive: Boxes, duration: float, channels: tuple[str, ...]) -> str:
    """A drive as CSV, each row holding until the next, that ends with both channels at rest at the duration [s]."""
    schedule = drive.schedule(duration, channels)
    lines = ["time_s," + ",".join(f"voltage_{name}_v" for name in channels)]
    lines += [
        ",".join(f"{number:.6f}".rstrip("0").rstrip(".") for number in (time, *row))
        for time, row in zip(schedule.time, schedule.signal, strict=True)
        if time < duration
    ]
    return "\n".join([*lines, ",".join([f"{duration:g}", *["0"] * len(channels)])]) + "\n"
