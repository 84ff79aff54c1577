# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a goal of `run_experiment` asks for: a waveform spelled out, a preset of the literature, or a file."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

import numpy as np
from hasel_common.inside_folder import inside_folder
from hasel_interfaces.action import RunExperiment
from hasel_recording.csv_columns import understand
from hasel_recording.csv_numbers import CsvNumbers
from hasel_recording.csv_run import drive_columns
from hasel_recording.csv_text import read_text
from hasel_recording.drive_channel import HASEL_PAIR
from hasel_recording.errors import RecordingError

from hasel_driver.protocol.faults import LimitError
from hasel_driver.protocol.limits import HARDWARE_MAXIMUM_V, MUSCLE_NAMES
from hasel_driver.protocol.waveform import LONGEST_S, FileWaveform, Waveform
from hasel_driver.safety.driven_experiment import ExperimentPlan

SHORTEST_ROW_S = 0.0099


@dataclass(frozen=True)
class Preset:
    """A waveform of which only the voltage is open, and the muscle; `rest_s` [s] at 0 V before and after."""

    meaning: str
    shape: str
    frequency_hz: float
    periods: int
    duty: float
    polarity: str
    rest_s: float

    def waveform(self, voltage_v: float, muscle: str) -> Waveform:
        """The waveform at a voltage [V]. Raises LimitError for more than one muscle: the bench holds one."""
        if muscle not in MUSCLE_NAMES:
            raise LimitError(f"A bench holds one muscle; muscles is {muscle!r}, upper or lower was expected.")
        return Waveform(
            self.shape, voltage_v, self.frequency_hz, self.periods, self.duty, self.polarity, muscle
        )


PRESETS: Mapping[str, Preset] = MappingProxyType(
    {
        # Kellaris, Gopaluni Venkata, Rothemund, Keplinger, Extreme Mechanics Letters 29 (2019) 100449
        "three_lifts": Preset(
            "a load lifted three times: a box of 0.1 Hz, 5 s on and 5 s off, its polarity reversed every time",
            shape="box",
            frequency_hz=0.1,
            periods=3,
            duty=1.0,
            polarity="alternating",
            rest_s=5.0,
        )
    }
)


def preset(name: str) -> Preset:
    """A preset by its name. Raises LimitError."""
    if name not in PRESETS:
        raise LimitError(f"preset is {name!r}, {', '.join(PRESETS)} or nothing was expected.")
    return PRESETS[name]


def read_waveform(path: Path) -> FileWaveform:
    """The drive in a CSV file of time_s, voltage_upper_v and voltage_lower_v, each row holding until the next.

    Raises:
        RecordingError: it cannot be read, or lacks a column.
        LimitError: times or voltages that no supply can give.
    """
    if not path.is_file():
        raise RecordingError(
            f"There is no waveform file {path}: check the name, as seen from the driver's machine."
        )
    text = read_text(path)
    columns = understand(text.names, {}, str(path), angle=False)
    numbers = CsvNumbers(text)
    time_s = numbers.times(columns.time)
    channels, voltages_v, _ = drive_columns(columns, numbers, text)
    if voltages_v is None or channels != HASEL_PAIR:
        expected = " and ".join(channel.column for channel in HASEL_PAIR)
        raise RecordingError(f"{path} has the columns {', '.join(text.names)}: {expected} were expected.")
    if len(time_s) < 2 or not 0.0 < time_s[-1] - time_s[0] <= LONGEST_S:
        raise LimitError(
            f"{path} lasts from its first row to its last: more than 0 and at most {LONGEST_S:g} s."
        )
    closest_s = float(np.diff(time_s).min())
    if closest_s < SHORTEST_ROW_S:
        raise LimitError(
            f"{path} has rows {closest_s * 1e3:.3g} ms apart, and the driver sends one in 10 ms:"
            " at least that was expected."
        )
    if not np.isfinite(voltages_v).all() or np.abs(voltages_v).max() > HARDWARE_MAXIMUM_V:
        raise LimitError(f"{path} holds a voltage that is no number, or above {HARDWARE_MAXIMUM_V:g} V.")
    return FileWaveform(path, time_s - time_s[0], voltages_v)


def below(folder: Path, given: str, what: str) -> Path:
    """The path that a goal names, which may come from anywhere: inside `folder` only. Raises LimitError."""
    try:
        return inside_folder(folder, given)
    except ValueError as error:
        raise LimitError(
            f"{what}: {error}: name one there, or start the node with another folder."
        ) from error


def plan_of(goal: RunExperiment.Goal, waveforms: Path) -> ExperimentPlan:
    """What a goal asks for, its waveform files below `waveforms`. Raises LimitError or RecordingError."""
    if goal.preset and goal.waveform_file:
        raise LimitError(
            f"The goal names the preset {goal.preset!r} and the file {goal.waveform_file!r}: give one of the two."
        )
    if goal.waveform_file:
        return ExperimentPlan(
            read_waveform(below(waveforms, goal.waveform_file, "waveform_file")), goal.rest_time
        )
    if goal.preset:
        chosen = preset(goal.preset)
        muscle = "upper" if goal.muscles == RunExperiment.Goal.BOTH else goal.muscles
        return ExperimentPlan(chosen.waveform(goal.voltage, muscle), goal.rest_time or chosen.rest_s)
    waveform = Waveform(
        shape=goal.waveform,
        voltage_v=goal.voltage,
        frequency_hz=goal.frequency,
        periods=goal.periods,
        duty=goal.duty,
        polarity=goal.polarity,
        muscles=goal.muscles,
    )
    return ExperimentPlan(waveform, goal.rest_time)
