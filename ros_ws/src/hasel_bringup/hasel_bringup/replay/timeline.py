"""A recording as the messages that were sent when it was made."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_recording import Recording
from hasel_recording.recording import held

from hasel_bringup.errors import BringupError

_PAUSE_S = 10.0
"""Between two recordings; so long that every node takes them for two runs."""


@dataclass(frozen=True)
class ReplayedFrame:
    """voltage [V] (upper, lower) from the stamp [ns] on; sin_theta: None between frames, NaN when not measured."""

    stamp_ns: int
    voltage: tuple[float, float]
    sin_theta: float | None


def timeline(recording: Recording) -> list[ReplayedFrame]:
    """One entry for every frame and every switch of the voltage, in order of time.

    Frames before the header's initial_time_s, which no comparison uses, are left out. Raises BringupError when nothing
    is left, RecordingError for a body that the rig's two voltages do not drive.
    """
    recording.check_hasel_pair()
    drive_time, drive_voltage = recording.recorded_drive()
    start = float(recording.metadata.get("initial_time_s", min(recording.time_s[0], drive_time[0])))
    if start > recording.time_s[-1]:
        raise BringupError(
            f"{recording.name} has no frame at or after initial_time_s = {start:g} s; correct its header"
        )
    times = np.unique(np.concatenate([[start], recording.time_s, drive_time]))
    times = times[times >= start]
    voltage = held(drive_time, drive_voltage, times)
    measured = dict(zip(recording.time_s.tolist(), recording.sin_theta.tolist(), strict=True))
    return [
        ReplayedFrame(round(time * 1e9), tuple(row), measured.get(time))
        for time, row in zip(times.tolist(), voltage.tolist(), strict=True)
    ]


def one_after_the_other(timelines: Sequence[list[ReplayedFrame]]) -> list[list[ReplayedFrame]]:
    """The first as it is, every further one moved to begin well after the one before."""
    placed: list[list[ReplayedFrame]] = []
    for frames in timelines:
        shift = placed[-1][-1].stamp_ns + round(_PAUSE_S * 1e9) - frames[0].stamp_ns if placed else 0
        placed.append([ReplayedFrame(f.stamp_ns + shift, f.voltage, f.sin_theta) for f in frames])
    return placed
