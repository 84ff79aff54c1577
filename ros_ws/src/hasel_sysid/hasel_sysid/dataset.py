"""Recordings as experiments: what was measured, and the run that a simulator can repeat."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from hasel_recording import Recording, read_recordings
from hasel_sim.drive.voltage import VoltageSchedule
from hasel_sim.model import Model
from hasel_sim.run import Run

from hasel_sysid.errors import SysidError

_MOST_LEVELS = 8
"""More voltages than this (a ramp, a sine) share so many amplitudes, spread over their range."""


@dataclass(frozen=True)
class Experiment:
    """A recording and the run that repeats it; sin_theta [n] is measured at run.time, NaN where it is not."""

    recording: Recording
    run: Run

    @property
    def name(self) -> str:
        """Name of the recording."""
        return self.recording.name

    @property
    def sin_theta(self) -> np.ndarray:
        """Measured sine of the bending angle, [n]."""
        return self.recording.sin_theta

    @property
    def voltage(self) -> float:
        """Largest voltage magnitude of the run [V]; 0 for a passive one."""
        return 0.0 if self.run.schedule is None else float(np.abs(self.run.schedule.voltage).max())

    @property
    def frequency(self) -> float:
        """Frequency of the drive [1/s] from the switches between the muscles; 0 for a passive or constant one."""
        if self.run.schedule is None:
            return 0.0
        v = np.abs(self.run.schedule.voltage)
        side = np.sign(v[:, 0] - v[:, 1])
        driven = side != 0
        time, side = self.run.schedule.time[driven], side[driven]
        turns = time[1:][np.diff(side) != 0]
        return 0.0 if len(turns) == 0 else float(0.5 / np.median(np.diff(np.concatenate([time[:1], turns]))))


def experiment(recording: Recording) -> Experiment:
    """The run of a recording, its start taken from the header lines.

    Raises SysidError for a header value that is not understood.
    """
    header = recording.metadata
    state = header.get("initial_state", "rest")
    if state not in ("rest", "static_equilibrium"):
        raise SysidError(
            f"{recording.name}: initial_state is '{state}'; expected rest or static_equilibrium: correct the header"
        )
    try:
        factor = float(header.get("initial_load_factor", 1.0))
        start = float(header["initial_time_s"]) if "initial_time_s" in header else None
    except ValueError:
        raise SysidError(
            f"{recording.name}: initial_load_factor and initial_time_s must be numbers: correct the header"
        ) from None
    schedule = None
    if recording.voltage is not None or recording.drive_time_s is not None:
        time, voltage = recording.drive()
        schedule = VoltageSchedule(np.asarray(time), np.asarray(voltage))
    return Experiment(recording, Run(recording.name, recording.time_s, schedule, state, factor, start))


def load_experiments(paths: Iterable[str | Path]) -> list[Experiment]:
    """Read recordings (.csv, .mcap) as experiments; an unreadable one among good ones is skipped with a warning.

    Raises RecordingError when none can be read.
    """
    return [experiment(recording) for recording in read_recordings(paths)]


def voltage_levels(experiments: Sequence[Experiment]) -> np.ndarray:
    """Voltages [V] that get an amplitude of their own, ascending: all that occur, or eight spread over many."""
    found = [e.run.schedule.levels() for e in experiments if e.run.schedule is not None]
    levels = np.unique(np.round(np.concatenate(found), 1)) if found else np.zeros(0)
    if len(levels) <= _MOST_LEVELS:
        return levels
    return np.linspace(levels[-1] / _MOST_LEVELS, levels[-1], _MOST_LEVELS)


def prepared(model: Model, experiments: Sequence[Experiment]) -> Model:
    """The model with an amplitude for every voltage of these experiments; passive models stay as they are.

    Raises SysidError when the experiments are driven and the body has no muscles.
    """
    levels = voltage_levels(experiments)
    if not model.has_muscles:
        if len(levels):
            raise SysidError(
                f"the recordings are driven with up to {levels[-1]:g} V, and model '{model.name}' has no muscles; "
                "choose the model with --model (swimmer is the default)"
            )
        return model
    return model if len(levels) == 0 else model.with_levels(levels)
