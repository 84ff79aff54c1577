# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A recording as an experiment: what was measured, the run that a simulator can repeat, and runs given twice."""

import warnings
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from hasel_recording import Recording, RecordingWarning
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.run import Run

from hasel_sysid.errors import SysidError

GENTLEST = 1 / 8
"""Share of its amplitudes at which a body can be simulated, if it can be at all."""
_SAME_TIME_S = 1e-6
"""A copy in another format keeps times to the nanosecond, and may count from another zero."""


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


def counted_once(experiments: Iterable[Experiment]) -> list[Experiment]:
    """The experiments without repeats, each of which is left out with a RecordingWarning."""
    found: list[Experiment] = []
    for each in experiments:
        if not is_repeat(each.recording, [earlier.recording for earlier in found]):
            found.append(each)
    return found


def is_repeat(recording: Recording, earlier: Iterable[Recording]) -> bool:
    """Whether it is one of the earlier ones; a RecordingWarning says so where it is."""
    known = _same_run(recording, earlier)
    if known is not None:
        warnings.warn(
            f"{recording.name} is the same run as {known.name} (same times, same angles) and counts once: twice the "
            "same noise is not two runs.",
            RecordingWarning,
            stacklevel=3,
        )
    return known is not None


def check_unseen(unseen: Iterable[Experiment], fitted: Sequence[Experiment]) -> None:
    """Raise SysidError where an unseen run is also among those to fit."""
    for each in unseen:
        known = _same_run(each.recording, [other.recording for other in fitted])
        if known is not None:
            raise SysidError(
                f"{each.name}, given as unseen, is the same run as {known.name}, which is not (same times, same "
                "angles); an unseen run is never fitted: leave out one of the two"
            )


def _same_run(recording: Recording, others: Iterable[Recording]) -> Recording | None:
    """The one of the others that is the same run; None where there is none."""
    return next((other for other in others if _is_same(recording, other)), None)


def _is_same(a: Recording, b: Recording) -> bool:
    return np.array_equal(a.sin_theta, b.sin_theta, equal_nan=True) and np.allclose(
        a.time_s - a.time_s[:1], b.time_s - b.time_s[:1], rtol=0.0, atol=_SAME_TIME_S
    )
