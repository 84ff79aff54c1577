"""Marker files of the public fish, srl-ethz/fishsim, as recordings."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from hasel_recording import DriveChannel, Recording
from hasel_recording.recording import sin_theta_from_markers

from hasel_sysid.errors import SysidError

PLACES = (".", "Markers", "Data/Markers")
"""Where the files lie in a clone, or in a folder of it."""
FRAMES_PER_SECOND = 60.0
HEAD_LENGTH = 0.142
"""Distance [m] of the two markers on the head, which gives the scale; both are said by the repository's own reader."""
MOTOR = DriveChannel("motor", "angle", "rad")
_NAME = re.compile(r"markers_f(\d+)_(\d+)$")
_LEAST_MARKERS, _LEAST_FRAMES = 4, 60


@dataclass(frozen=True)
class FilmedRun:
    """A film of the fish: named_frequency: of the motor, in the file's name [Hz]; recording: markers [m], y up.

    The markers are head and middle, which are fixed to the head, and along the tail tail_1 … and tail.
    """

    named_frequency: float
    recording: Recording


def filmed_runs(folder: Path) -> list[FilmedRun]:
    """All runs of a folder, by their named frequency. Raises SysidError for none, or a file of another form."""
    found = [path for place in PLACES for path in (folder / place).glob("markers_f*.csv")]
    named = {path: match for path in found if (match := _NAME.match(path.stem))}
    if not named:
        raise SysidError(
            f"there is no markers_f1_00.csv or its like in {folder}, nor in its {PLACES[-1]}; expected a clone of the "
            "public repository srl-ethz/fishsim: name its folder"
        )
    runs = [_run(path, float(f"{match[1]}.{match[2]}")) for path, match in named.items()]
    return sorted(runs, key=lambda run: run.named_frequency)


def _run(path: Path, frequency: float) -> FilmedRun:
    pixels = _markers(path)
    size = float(np.linalg.norm(pixels[:, 1] - pixels[:, 0], axis=1).mean())
    if not size > 0 or not frequency > 0:
        raise SysidError(
            f"{path}: the two markers on the head are {size:g} px apart and the named frequency is {frequency:g} Hz; "
            "expected both above 0: is it a marker file of the fish?"
        )
    markers = HEAD_LENGTH / size * pixels * np.array([1.0, -1.0])
    tail = pixels.shape[1] - 3
    names = ("head", "middle", *(f"tail_{number}" for number in range(1, tail + 1)), "tail")
    time = np.arange(len(markers)) / FRAMES_PER_SECOND
    turns = np.arange(0.0, time[-1], 0.5 / frequency)
    bare = Recording(
        path.stem.removeprefix("markers_"),
        time,
        np.zeros(len(time)),
        markers=markers,
        marker_names=names,
        drive_time_s=turns,
        drive_values=np.where(np.arange(len(turns)) % 2 == 0, np.pi, 0.0)[:, None],
        channels=(MOTOR,),
        path=path,
    )
    return FilmedRun(frequency, replace(bare, sin_theta=sin_theta_from_markers(bare.angle_markers)))


def _markers(path: Path) -> np.ndarray:
    """Markers [px] [frames, markers, 2], y down. Raises SysidError for a file that does not hold them."""
    try:
        rows = np.loadtxt(path, delimiter=",", ndmin=2)
    except ValueError as error:
        raise SysidError(
            f"{path}: {error}; expected rows of x, y of all markers in px, separated by commas: correct that line"
        ) from None
    frames, columns = rows.shape
    if columns % 2 or columns < 2 * _LEAST_MARKERS or frames < _LEAST_FRAMES or not np.isfinite(rows).all():
        raise SysidError(
            f"{path} holds {frames} rows of {columns} numbers; expected at least {_LEAST_FRAMES} rows of x and y of at "
            f"least {_LEAST_MARKERS} markers in px, all finite: is it a marker file of the fish?"
        )
    return rows.reshape(frames, columns // 2, 2)
