"""A recording as an experiment: what was measured, and the run that a simulator can repeat."""

from dataclasses import dataclass

import numpy as np
from hasel_recording import Recording
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.run import Run

from hasel_sysid.errors import SysidError

GENTLEST = 1 / 8
"""Share of its amplitudes at which a body can be simulated, if it can be at all."""


@dataclass(frozen=True)
class Experiment:
    """A recording and the run that repeats it, or its first frames; sin_theta [n] is measured at run.time, NaN where it
    is not.
    """

    recording: Recording
    run: Run

    @property
    def name(self) -> str:
        """Name of the recording."""
        return self.recording.name

    @property
    def sin_theta(self) -> np.ndarray:
        """Measured sine of the bending angle, [n]."""
        return self.recording.sin_theta[: len(self.run.time)]

    @property
    def outputs(self) -> np.ndarray:
        """What was measured of what a simulation gives: sin theta alone, [n, outputs]."""
        return self.sin_theta[:, None]

    def __str__(self) -> str:
        return str(self.recording)

    __repr__ = __str__


def experiment_of(recording: Recording) -> Experiment:
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
    if recording.driven:
        time, signal = recording.drive()
        names = tuple(channel.name for channel in recording.channels)
        schedule = DriveSchedule(np.asarray(time), np.asarray(signal), names)
    return Experiment(recording, Run(recording.name, recording.time_s, schedule, state, factor, start))
