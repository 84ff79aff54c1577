"""The drive's recording (voltages over time), and when it ran relative to the video."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from hasel_recording import RecordingError
from hasel_recording.mcap_file import read_file
from hasel_recording.message_fields import nanoseconds
from hasel_recording.topics import STATE, TOPIC_TYPES

from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.drive_lag import estimate_lag
from hasel_tracker.offline.tracked_run import TrackedRun

LAMP_SHARE, LEAST_LAMP_LEVELS = 0.05, 30.0
COLUMNS = ("time_s", "voltage_upper_v", "voltage_lower_v")


@dataclass(frozen=True)
class Drive:
    """Voltages (m, 2) [V], upper and lower, each from its time_s (m,) on; `start_stamp_ns` of time 0.

    The last voltage holds for as long as voltages did in the median: longer is not known.
    """

    time_s: np.ndarray
    voltage: np.ndarray
    start_stamp_ns: int | None = None

    def at(self, time_s: np.ndarray) -> np.ndarray:
        """Voltages [V] at some times, shape (n, 2); 0 V before the first row, NaN after the recording's end."""
        row = np.searchsorted(self.time_s, time_s + 1e-9, side="right") - 1
        held = np.where((row >= 0)[:, None], self.voltage[np.maximum(row, 0)], 0.0)
        return np.where((time_s > self.end_s + 1e-9)[:, None], np.nan, held)

    @property
    def end_s(self) -> float:
        """Until when the voltage is known [s]."""
        steps = np.diff(self.time_s)
        return float(self.time_s[-1] + (np.median(steps) if steps.size else 0.0))


@dataclass(frozen=True)
class Alignment:
    """Drive time + lag_s = video time; how it was found, and how far it may be off [s]."""

    lag_s: float
    uncertainty_s: float
    means: str

    def __str__(self) -> str:
        lag = f"{self.lag_s:+.4f} s ± {self.uncertainty_s:.4f} s"
        return f"The drive's time zero is at {lag} of the video ({self.means})."


def read_drive(path: Path) -> Drive:
    """Read the voltages of an .mcap recording (topic /hasel/state) or of a .csv file; raises TrackerError."""
    path = Path(path)
    if not path.is_file():
        raise TrackerError(f"There is no drive recording {path}; give the .mcap or .csv of the run.")
    if path.suffix.lower() == ".mcap":
        return _from_mcap(path)
    if path.suffix.lower() == ".csv":
        return _from_csv(path)
    raise TrackerError(f"The drive recording {path} is neither .mcap nor .csv; give one of these.")


def _from_mcap(path: Path) -> Drive:
    try:
        states = read_file(path).decoded(STATE, TOPIC_TYPES[STATE])
    except (RecordingError, OSError) as error:
        raise TrackerError(str(error)) from error
    if not states:
        raise TrackerError(f"{path} has no {STATE} messages; record the driver's state too.")
    stamps = np.array([nanoseconds(each.header.stamp) for each in states], dtype=np.int64)
    voltage = np.array([each.commanded_voltage for each in states], dtype=float)
    return Drive((stamps - stamps[0]) / 1e9, voltage, int(stamps[0]))


def _from_csv(path: Path) -> Drive:
    lines = [
        line for line in path.read_text(errors="replace").splitlines() if line and not line.startswith("#")
    ]
    names = [name.strip() for name in lines[0].split(",")] if lines else []
    missing = [name for name in COLUMNS if name not in names]
    if missing:
        raise TrackerError(f"{path} has no column {missing[0]}; expected the columns {', '.join(COLUMNS)}.")
    try:
        table = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]]).reshape(
            -1, len(names)
        )
    except ValueError as error:
        raise TrackerError(
            f"{path} has a row that is not numbers ({error}); correct or remove it."
        ) from error
    if not len(table):
        raise TrackerError(f"{path} has a header but no rows; give the recording of a run.")
    time_s, upper, lower = (table[:, names.index(name)] for name in COLUMNS)
    if (np.diff(time_s) <= 0.0).any():
        raise TrackerError(f"{path}: time_s does not increase everywhere; sort the rows.")
    return Drive(time_s, np.column_stack([upper, lower]))


def align_by_stamp(run: TrackedRun, drive: Drive) -> Alignment:
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
    return Alignment(lag, 0.5 / run.frame_rate_hz, "from the stamps of both")


def align_by_response(run: TrackedRun, drive: Drive) -> Alignment:
    """Lag at which the drive foretells the angle best over the whole run; TrackerError if it is not determined."""
    found = estimate_lag(run.time_s, run.sin_theta, drive.time_s, drive.voltage, drive.end_s)
    return Alignment(found.lag_s, found.uncertainty_s, "from the body's answer to the drive")


def align_by_hand(lag_s: float, run: TrackedRun, drive: Drive) -> Alignment:
    """A lag that the user gives; TrackerError if video and drive then do not overlap."""
    if lag_s + drive.end_s < run.time_s[0] or lag_s + drive.time_s[0] > run.time_s[-1]:
        raise TrackerError(
            f"With a lag of {lag_s:+.3f} s the drive ({drive.time_s[0]:.3f} to {drive.end_s:.3f} s) and the video "
            f"({run.time_s[0]:.3f} to {run.time_s[-1]:.3f} s) do not overlap; the lag is added to the drive's time."
        )
    return Alignment(lag_s, 0.5 / run.frame_rate_hz, "as given")


def align_by_lamp(run: TrackedRun, drive: Drive, lamp: np.ndarray) -> Alignment:
    """Lag at which a lamp that lights with the drive does so; lamp: its brightness (n,) in each frame."""
    driven = np.abs(drive.voltage).max(axis=1)
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
    return Alignment(float(between - drive.time_s[first]), 0.5 / run.frame_rate_hz, "from the lamp in view")


def until_drive_ends(run: TrackedRun, drive: Drive, alignment: Alignment) -> tuple[TrackedRun, str]:
    """The run as long as its drive is known, and a sentence about what was left out, or ''."""
    end_s = drive.end_s + alignment.lag_s
    left_out = int((run.time_s > end_s + 1e-9).sum())
    if not left_out:
        return run, ""
    return run.between(run.time_s[0], end_s + 2e-9), (
        f"The drive's recording ends {run.time_s[-1] - end_s:.3f} s before the video: the voltage of the last "
        f"{left_out} frames is not known, so they were left out; track without --drive to have them."
    )
