"""The drive's recording (voltages over time), and when it ran relative to the video."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from hasel_recording import RecordingError
from hasel_recording.mcap_file import read_file
from hasel_recording.message_fields import nanoseconds
from hasel_recording.topics import STATE, TOPIC_TYPES

from hasel_tracker.errors import TrackerError
from hasel_tracker.offline.movement import first_movement_s
from hasel_tracker.offline.tracked_run import TrackedRun

COLUMNS = ("time_s", "voltage_upper_v", "voltage_lower_v")


@dataclass(frozen=True)
class Drive:
    """Voltages (m, 2) [V], upper and lower, each from its time_s (m,) on; `start_stamp_ns` of time 0."""

    time_s: np.ndarray
    voltage: np.ndarray
    start_stamp_ns: int | None = None

    def at(self, time_s: np.ndarray) -> np.ndarray:
        """Voltages [V] at some times, shape (n, 2); 0 V before the first row."""
        row = np.searchsorted(self.time_s, time_s + 1e-9, side="right") - 1
        return np.where((row >= 0)[:, None], self.voltage[np.maximum(row, 0)], 0.0)

    @property
    def first_voltage_s(self) -> float:
        """Time [s] at which a muscle first gets a voltage; raises TrackerError if none ever does."""
        driven = np.flatnonzero(np.abs(self.voltage).max(axis=1) > 0.0)
        if not driven.size:
            raise TrackerError("The drive's recording is 0 V throughout; give that of the run in the video.")
        return float(self.time_s[driven[0]])


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


def align_by_movement(run: TrackedRun, drive: Drive) -> Alignment:
    """Lag from what must coincide: the first voltage and the first movement.

    The body answers within a frame or two of the voltage, so this is right to about one frame; the lag that
    a slow supply or muscle adds is not seen as such.
    """
    moved = first_movement_s(run.time_s, run.sin_theta)
    return Alignment(
        moved - drive.first_voltage_s, 1.0 / run.frame_rate_hz, "the first movement set to the first voltage"
    )
