# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The drive's recording (voltages, or whatever drives the body, over time), and when it ran relative to the video."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from hasel_recording import HASEL_PAIR, DriveChannel, RecordingError
from hasel_recording.reading import SUFFIXES
from hasel_recording.reading import read_drive as read_recorded_drive
from hasel_recording.recording import held

from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.drive_lag import estimate_lag
from hasel_tracker.offline.tracked_run import TrackedRun

LAMP_SHARE, LEAST_LAMP_LEVELS = 0.05, 30.0


@dataclass(frozen=True)
class Drive:
    """Values (k, channels) in SI units, each from its time_s (k,) on; `start_stamp_ns` of time 0.

    The last value holds for as long as values did in the median: longer is not known.
    """

    time_s: np.ndarray
    values: np.ndarray
    start_stamp_ns: int | None = None
    channels: tuple[DriveChannel, ...] = HASEL_PAIR

    def at(self, time_s: np.ndarray) -> np.ndarray:
        """Values at some times, shape (n, channels); 0 before the first row, NaN after the recording's end."""
        known = held(self.time_s, self.values, time_s + 1e-9)
        return np.where((time_s > self.end_s + 1e-9)[:, None], np.nan, known)

    @property
    def end_s(self) -> float:
        """Until when the drive is known [s]."""
        steps = np.diff(self.time_s)
        return float(self.time_s[-1] + (np.median(steps) if steps.size else 0.0))


@dataclass(frozen=True)
class DriveAlignment:
    """Drive time + lag_s = video time; how it was found, and how far it may be off [s]."""

    lag_s: float
    uncertainty_s: float
    means: str

    def __str__(self) -> str:
        lag = f"{self.lag_s:+.4f} s ± {self.uncertainty_s:.4f} s"
        return f"The drive's time zero is at {lag} of the video ({self.means})."


def read_drive(path: Path) -> Drive:
    """Read the drive of an .mcap recording or a .csv file, as compare and fit do; raises TrackerError."""
    if Path(path).suffix.lower() not in SUFFIXES and not Path(path).is_dir():
        raise TrackerError(f"The drive recording {path} is neither .mcap nor .csv; give one of these.")
    try:
        drive = read_recorded_drive(Path(path))
    except (RecordingError, OSError) as error:
        raise TrackerError(str(error)) from error
    return Drive(drive.time_s, drive.values, drive.start_ns, drive.channels)


def align_by_stamp(run: TrackedRun, drive: Drive) -> DriveAlignment:
    """Lag from the clocks of both recordings; raises TrackerError if one has none or they do not overlap."""
    if run.start_stamp_ns is None or drive.start_stamp_ns is None:
        which = "video" if run.start_stamp_ns is None else "drive's recording"
        raise TrackerError(f"The {which} has no stamps, so it cannot be merged by stamp; use --merge lag.")
    lag = (drive.start_stamp_ns - run.start_stamp_ns) * 1e-9
    if lag + drive.time_s[-1] < run.time_s[0] or lag + drive.time_s[0] > run.time_s[-1]:
        raise TrackerError(
            f"The drive was recorded {lag:+.1f} s from the video and does not overlap with it; give that "
            f"of this run."
        )
    return DriveAlignment(lag, 0.5 / run.frame_rate_hz, "from the stamps of both")


def align_by_response(run: TrackedRun, drive: Drive) -> DriveAlignment:
    """Lag at which the drive foretells the angle best over the whole run; TrackerError if it is not determined."""
    if drive.channels != HASEL_PAIR:
        raise TrackerError(
            f"The lag is found from the rig's two voltages only, and the drive has "
            f"{', '.join(channel.column for channel in drive.channels)}; give --lag SECONDS or --led."
        )
    found = estimate_lag(run.time_s, run.sin_theta, drive.time_s, drive.values, drive.end_s)
    return DriveAlignment(found.lag_s, found.uncertainty_s, "from the body's answer to the drive")


def align_by_hand(lag_s: float, run: TrackedRun, drive: Drive) -> DriveAlignment:
    """A lag that the user gives; TrackerError if video and drive then do not overlap."""
    if lag_s + drive.end_s < run.time_s[0] or lag_s + drive.time_s[0] > run.time_s[-1]:
        raise TrackerError(
            f"With a lag of {lag_s:+.3f} s the drive ({drive.time_s[0]:.3f} to {drive.end_s:.3f} s) and the video "
            f"({run.time_s[0]:.3f} to {run.time_s[-1]:.3f} s) do not overlap; the lag is added to the drive's time."
        )
    return DriveAlignment(lag_s, 0.5 / run.frame_rate_hz, "as given")


def align_by_lamp(run: TrackedRun, drive: Drive, lamp: np.ndarray) -> DriveAlignment:
    """Lag at which a lamp that lights with the drive does so; lamp: its brightness (n,) in each frame."""
    driven = np.abs(drive.values).max(axis=1)
    first = int(np.argmax(driven > LAMP_SHARE * driven.max()))
    low, high = np.quantile(lamp, [0.02, 0.98])
    lit = lamp > 0.5 * (low + high)
    if high - low < LEAST_LAMP_LEVELS or lit[0] or not driven.max() > 0.0:
        raise TrackerError(
            f"The lamp's brightness goes from {low:.0f} to {high:.0f}, and it is {'lit' if lit[0] else 'dark'} in the "
            "first frame; expected it dark at first and clearly brighter when the drive starts: point --led at it."
        )
    index = int(np.argmax(lit))
    between = 0.5 * (run.time_s[index - 1] + run.time_s[index])
    return DriveAlignment(
        float(between - drive.time_s[first]), 0.5 / run.frame_rate_hz, "from the lamp in view"
    )


def after_the_drive(run: TrackedRun, drive: Drive, alignment: DriveAlignment) -> str:
    """A sentence about the frames whose drive is not known, or ''."""
    end_s = drive.end_s + alignment.lag_s
    count = int((run.time_s > end_s + 1e-9).sum())
    if not count:
        return ""
    return (
        f"The drive's recording ends {run.time_s[-1] - end_s:.3f} s before the video: what drove the body in the last "
        f"{count} frames is not known and stays blank (NaN); compare and fit leave these frames out."
    )
