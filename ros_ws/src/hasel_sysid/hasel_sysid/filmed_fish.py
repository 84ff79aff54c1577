# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The public filmed fish, srl-ethz/fishsim: its marker files as recordings, how its tail beats, how fast it swims."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from hasel_recording import DriveChannel, Recording
from hasel_recording.recording import MARKER_NAMES, sin_theta_from_markers
from hasel_sim.swimming.given_shape import Beat, Fish, beat_shape
from scipy.optimize import minimize_scalar

from hasel_sysid.errors import SysidError

PLACES = (".", "Markers", "Data/Markers")
"""Where the files lie in a clone, or in a folder of it."""
FRAMES_PER_SECOND = 60.0
HEAD_LENGTH = 0.142
"""Distance [m] of the two markers on the head, which gives the scale; both are said by the repository's own reader."""
MOTOR = DriveChannel("motor", "angle", "rad")
_NAME = re.compile(r"markers_f(\d+)_(\d+)$")
_LEAST_MARKERS, _LEAST_FRAMES = 4, 60
TAIL_BASE = 0.27
"""First hinge of the tail [m], along the head's axis from the middle between the head's markers."""
DEPTH, MASS = 0.1, 1.6
"""Of the fish, m and kg: tail height in the public model, and estimated from its shape."""
_FREQUENCIES = np.arange(0.2, 4.0, 0.002)
_APART = 0.01
"""Mean distance [m] along the axis below which two markers are not told apart: a tracker has taken one for another."""


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
    three = markers[:, [names.index(name) for name in MARKER_NAMES]]
    return FilmedRun(frequency, replace(bare, sin_theta=sin_theta_from_markers(three)))


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


@dataclass(frozen=True)
class SeenBeat:
    """beat: of the last marker; places [m] and complex deflections [m] of all markers behind the head's, [n].

    apart: whether the tracker told all markers from one another.
    """

    named_frequency: float
    beat: Beat
    places: np.ndarray
    deflections: np.ndarray

    @property
    def ratio(self) -> float:
        """Frequency of the tail over that of the file's name [1]."""
        return self.beat.frequency / self.named_frequency

    @property
    def apart(self) -> bool:
        """Whether the tracker told all markers from one another."""
        return bool(np.diff(self.places).min() > _APART)


def seen_beat(run: FilmedRun) -> SeenBeat:
    """A sine fitted to every marker, at the frequency that explains the last one best; the speed by a fitted line.

    The fish swims along its head's axis, whose turning is followed from frame to frame.
    """
    recording = run.recording
    markers = np.asarray(recording.markers)
    head = markers[:, :2].mean(axis=1)
    axis = markers[:, 1] - markers[:, 0]
    axis /= np.linalg.norm(axis, axis=1)[:, None]
    arms = markers[:, 2:] - head[:, None]
    along = np.einsum("tmd,td->tm", arms, axis)
    across = axis[:, None, 0] * arms[..., 1] - axis[:, None, 1] * arms[..., 0]
    frequency = _frequency(recording.time_s, across[:, -1])
    deflections = _sines(recording.time_s, across, frequency)[1]
    forwards = -np.einsum("td,td->t", np.diff(head, axis=0), axis[1:])
    way = np.concatenate([[0.0], np.cumsum(forwards)])
    speed = float(np.polyfit(recording.time_s, way, 1)[0])
    places = along.mean(axis=0)
    last = Beat(frequency, float(np.abs(deflections[-1])), float(places[-1]), speed)
    return SeenBeat(run.named_frequency, last, places, deflections)


def fish_of(beats: Sequence[SeenBeat]) -> Fish:
    """The fish with one shape of the beat for all runs, from those whose markers are told apart.

    Raises SysidError where there is no such run.
    """
    good = [beat for beat in beats if beat.apart]
    if not good:
        raise SysidError(
            f"in none of the {len(beats)} runs are all markers of the tail told apart by {1e3 * _APART:g} mm; expected "
            "one from which to learn the tail's shape: track the markers anew"
        )
    s = np.concatenate([(b.places - TAIL_BASE) / (b.places[-1] - TAIL_BASE) for b in good])
    deflection = np.concatenate([b.deflections / b.deflections[-1] for b in good])
    behind = s > 0
    return Fish(-0.5 * HEAD_LENGTH, TAIL_BASE, beat_shape(s[behind], deflection[behind]), DEPTH, MASS)


def _frequency(time: np.ndarray, series: np.ndarray) -> float:
    """Frequency [Hz] of the sine that explains a series best."""

    def left(frequency: float) -> float:
        return float(_sines(time, series[:, None], frequency)[0])

    start = _FREQUENCIES[np.argmin([left(f) for f in _FREQUENCIES])]
    return float(minimize_scalar(left, bounds=(start - 0.004, start + 0.004), method="bounded").x)


def _sines(time: np.ndarray, series: np.ndarray, frequency: float) -> tuple[float, np.ndarray]:
    """What sines of a frequency leave of series [n, k], sum of squares, and their complex amplitudes [k]."""
    phase = 2 * np.pi * frequency * time
    columns = np.column_stack([np.ones_like(time), np.cos(phase), np.sin(phase)])
    found = np.linalg.lstsq(columns, series, rcond=None)[0]
    return float(((series - columns @ found) ** 2).sum()), found[1] - 1j * found[2]
