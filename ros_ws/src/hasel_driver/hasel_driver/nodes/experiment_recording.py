# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The recording of one experiment, and the proof from the file itself that it holds what it should."""

import itertools
import math
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

import numpy as np
from hasel_common.topics import STATE, TOPIC_TYPES
from hasel_recording.bag import McapFile, read_file
from hasel_recording.errors import RecordingError
from hasel_recording.mcap_recorder import McapRecorder

from hasel_driver.nodes.experiment_goal import below
from hasel_driver.protocol.faults import LimitError
from hasel_driver.protocol.limits import MUSCLE_NAMES
from hasel_driver.protocol.waveform import MUSCLES, FileWaveform, Waveform
from hasel_driver.safety.driven_experiment import ExperimentPlan

SUFFIX = ".mcap"
MOST_STATE_GAP_S = 0.2
MOST_TOPIC_GAP_S = 1.0
SAMPLE_S = 0.02  # longest usual distance of two states
TOLERANCE_V = 1.0  # the board counts in whole volts


def chosen_path(folder: Path, output: str) -> Path:
    """The path that a goal names, with its suffix. Raises LimitError for a name that is no file inside `folder`."""
    path = below(folder, output, "output")
    return path if path.suffix == SUFFIX else path.with_name(path.name + SUFFIX)


def reserve(path: Path) -> Path:
    """Create `path`, empty, and return it. Raises LimitError where it exists, OSError where it cannot be made."""
    path.parent.mkdir(parents=True, exist_ok=True)
    try:
        path.open("xb").close()
    except FileExistsError as error:
        raise LimitError(
            f"{path} exists already, and no recording is overwritten: choose another output, or leave it empty."
        ) from error
    return path


def reserve_unique(folder: Path, name: str) -> Path:
    """A file in `folder` named by the time to the millisecond and `name`, numbered where that is taken."""
    moment = datetime.now().strftime("%Y-%m-%d_%H-%M-%S-%f")[:-3]
    numbered = (f"{moment}_{name}_{number}{SUFFIX}" for number in itertools.count(2))
    path = folder / f"{moment}_{name}{SUFFIX}"
    while True:
        try:
            return reserve(path)
        except LimitError:
            path = folder / next(numbered)


@dataclass
class ExperimentRecording:
    """Writes messages while the run lasts; `missing` reads the closed file back. `path` is a reserved, empty file."""

    path: Path
    plan: ExperimentPlan
    required_topics: tuple[str, ...] = ()
    state_topic: str = STATE
    made_by: Mapping[str, str] = field(default_factory=dict)  # as of hasel_common.provenance
    problem: str | None = None  # why nothing more can be written
    _closed: bool = False
    _recorder: McapRecorder = field(init=False)
    _last_ns: dict[str, int] = field(default_factory=dict)
    _lock: threading.Lock = field(default_factory=threading.Lock)

    def __post_init__(self) -> None:
        metadata = {**self.plan.waveform.metadata(), "rest_time_s": f"{self.plan.rest_s:g}", **self.made_by}
        self._recorder = McapRecorder(self.path, metadata)

    def write(self, topic: str, message: Any) -> None:
        """Append a message at its header's stamp; one not later than the last of its topic is dropped.

        A full disk is kept as `problem` and not raised: whoever writes has a supply to watch.
        """
        stamp_ns = message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec
        with self._lock:
            if self._closed or self.problem or stamp_ns <= self._last_ns.get(topic, -1):
                return
            self._last_ns[topic] = stamp_ns
            try:
                self._recorder.write(topic, message, stamp_ns)
            except (OSError, RecordingError) as error:
                self.problem = str(error)

    def close(self) -> None:
        """Finish the file; what is written afterwards is dropped. Raises RecordingError."""
        with self._lock:
            self._closed = True
        self._recorder.close()

    def missing(self, duration_s: float) -> list[str]:
        """What the closed file lacks of a run of `duration_s` [s], in words; empty if it is complete."""
        content = read_file(self.path)
        lacking = [_coverage(content, self.state_topic, duration_s, MOST_STATE_GAP_S)]
        lacking += [_coverage(content, topic, duration_s, MOST_TOPIC_GAP_S) for topic in self.required_topics]
        if not any(lacking):
            lacking += _drive_lacking(content, self.state_topic, self.plan.waveform)
        return [text for text in lacking if text]


def _coverage(content: McapFile, topic: str, duration_s: float, most_gap_s: float) -> str | None:
    stamps_s = np.array([message.log_time for message in content.messages.get(topic, [])]) * 1e-9
    if stamps_s.size == 0:
        return f"no message of {topic}"
    span_s = stamps_s[-1] - stamps_s[0]
    if span_s < duration_s - 2 * most_gap_s:
        return f"{topic} covers {span_s:.2f} s of {duration_s:.2f} s"
    longest_s = float(np.diff(stamps_s).max(initial=0.0))
    if longest_s > most_gap_s:
        return f"{topic} has a gap of {longest_s:.2f} s"
    return None


def _drive_lacking(content: McapFile, topic: str, waveform: Waveform | FileWaveform) -> list[str]:
    states = content.decoded(topic, TOPIC_TYPES[STATE])
    voltage_v = np.array([state.commanded_voltage for state in states])  # [n, 2]
    if isinstance(waveform, FileWaveform):
        return _file_lacking(voltage_v, waveform)
    return _waveform_lacking(np.abs(voltage_v), waveform)


def _file_lacking(voltage_v: np.ndarray, waveform: FileWaveform) -> list[str]:
    """The first of the rows that were held long enough for the states to show them, and were not, in their order."""
    held = np.flatnonzero(np.diff(waveform.time_s) >= 2 * SAMPLE_S)
    states = iter(voltage_v)
    state_v = next(states, None)
    for row in held:
        row_v = waveform.voltages_v[row]
        while state_v is not None and abs(state_v - row_v).max() > TOLERANCE_V:
            state_v = next(states, None)
        if state_v is None:
            return [f"the row of {waveform.time_s[row]:g} s, {row_v[0]:g} and {row_v[1]:g} V, was not seen"]
    return []


def _waveform_lacking(voltage_v: np.ndarray, waveform: Waveform) -> list[str]:
    window_s = 0.5 * waveform.duty / waveform.frequency_hz
    if window_s < 2 * SAMPLE_S or waveform.voltage_v < 1.0:
        return []  # too short for the states to show
    tolerance_v = TOLERANCE_V
    if waveform.shape != "box":
        tolerance_v += waveform.voltage_v * 2 * SAMPLE_S / window_s
    lacking = []
    for muscle, delay, series in zip(MUSCLE_NAMES, MUSCLES[waveform.muscles], voltage_v.T, strict=True):
        expected_v = 0.0 if delay is None else waveform.voltage_v
        peak_v = float(series.max())
        if not math.isclose(peak_v, expected_v, abs_tol=tolerance_v if expected_v else TOLERANCE_V):
            lacking.append(f"the {muscle} muscle reached {peak_v:.0f} V of {expected_v:.0f} V")
        # Without a rest the first drive may have begun before the first state: what came before it was 0 V.
        drives = int(np.count_nonzero(np.diff((series > 0).astype(int), prepend=0) == 1))
        if expected_v and drives != waveform.periods:
            lacking.append(f"the {muscle} muscle was driven {drives} times of {waveform.periods}")
    return lacking
