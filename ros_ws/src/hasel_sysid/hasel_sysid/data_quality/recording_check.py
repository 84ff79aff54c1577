# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""All checks of a recording that need no model, and what was understood of it before anything is fitted."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from hasel_common.provenance import without_provenance
from hasel_recording import DriveChannel, Recording

from hasel_sysid.data_quality.angle import check_angle, check_markers
from hasel_sysid.data_quality.drive_command import check_command
from hasel_sysid.data_quality.finding import DataFinding, Severity
from hasel_sysid.data_quality.frames import check_frames, check_header
from hasel_sysid.data_quality.response import check_drive_frequency, check_response
from hasel_sysid.residual_analysis.drive_cycle import cycle_of
from hasel_sysid.residual_analysis.robust_statistics import high_frequency_noise

_STOP = {"too few frames", "time order", "unit of time", "run of hours"}
_NO_RESPONSE = {"unit of the angle", "frozen angle", "command equals measurement", "lost command"}
_MOST_SHOWN = 6


def check_recording(recording: Recording) -> list[DataFinding]:
    """Faults of the set-up that the recording shows by itself, errors first."""
    found = [*check_header(recording), *check_frames(recording)]
    if not _STOP & {finding.fault for finding in found}:
        found += [*check_angle(recording), *check_command(recording), *check_markers(recording)]
        if not _NO_RESPONSE & {finding.fault for finding in found}:
            found += [*check_response(recording), *check_drive_frequency(recording)]
    return ordered(recording.name, found)


def refusal(recording: Recording) -> DataFinding | None:
    """The fault with which a recording cannot even be simulated; None where it can."""
    return next((f for f in ordered(recording.name, check_frames(recording)) if f.fault in _STOP), None)


def ordered(name: str, found: list[DataFinding]) -> list[DataFinding]:
    """The findings with the recording's name, errors first."""
    named = [replace(finding, recording=name) for finding in found]
    return sorted(named, key=lambda finding: finding.severity is not Severity.ERROR)


@dataclass(frozen=True)
class Summary:
    """rows: (what, said) in the order in which a person reads them; findings: what is wrong; misfit: to the model."""

    recording: Recording
    rows: tuple[tuple[str, str], ...]
    findings: tuple[DataFinding, ...]
    misfit: bool = False

    @property
    def good(self) -> bool:
        """Whether nothing was found with which results would mislead."""
        return not self.misfit and all(finding.severity is not Severity.ERROR for finding in self.findings)

    def __str__(self) -> str:
        rows = [f"  {what:<8} {said}" for what, said in self.rows]
        found = [f"  {finding.severity.value:<8} {finding.sentence}" for finding in self.findings]
        found = found or ([] if self.misfit else ["  looks in order"])
        return "\n".join([str(self.recording.path or self.recording.name), *rows, *found])

    def to_json(self) -> dict[str, Any]:
        """Plain words and numbers."""
        return {
            "name": self.recording.name,
            "understood": [{"what": what, "said": said} for what, said in self.rows],
            "findings": [finding.to_json() for finding in self.findings],
            "good": self.good,
        }


def summary(recording: Recording, model: Sequence[str] = (), misfit: bool = False) -> Summary:
    """What a recording holds, line by line, and what looks wrong in it.

    model: what is to be said of a model; misfit: whether it cannot be used with that model.
    """
    rows = [("frames", _frames(recording)), ("angle", _angle(recording))]
    rows += [("drive", line) for line in _drive(recording)]
    rows += [("markers", _markers(recording)), ("start", _start(recording))]
    rows += [("read", sentence) for sentence in (*recording.understood, *recording.ripple)]
    header, made = without_provenance(recording.metadata)
    rows += [("header", f"{key}: {value}") for key, value in header.items()]
    rows += [("recorded", made)] if made else []
    rows += [("model", sentence) for sentence in model]
    rows += [("model", "does not fit: see the error")] if misfit else []
    return Summary(recording, tuple(rows), tuple(check_recording(recording)), misfit)


def _frames(recording: Recording) -> str:
    time = recording.time_s
    text = f"{len(time)} from {time[0]:.6g} to {time[-1]:.6g} s"
    if len(time) > 1:
        text += f", {1 / float(np.median(np.diff(time))):.5g} per second"
    lost = len(time) - int(recording.valid.sum())
    return f"{text}, {lost} without an angle" if lost else text


def _angle(recording: Recording) -> str:
    sin_theta = recording.sin_theta[recording.valid]
    low, high = np.degrees(np.arcsin(np.clip([sin_theta.min(), sin_theta.max()], -1, 1)))
    text = f"sin θ from {sin_theta.min():.4g} to {sin_theta.max():.4g} (θ from {low:.3g}° to {high:.3g}°)"
    if len(sin_theta) < 16:
        return text
    return f"{text}, noise of single frames about {high_frequency_noise(sin_theta):.2g}"


def _drive(recording: Recording) -> list[str]:
    if not recording.driven:
        return ["none: a passive body"]
    time, values = recording.drive()
    lines = [
        f"{channel}: {_levels(channel, signal)}"
        for channel, signal in zip(recording.channels, values.T, strict=True)
    ]
    frame = float(np.median(np.diff(recording.time_s))) if len(recording.time_s) > 1 else 0.0
    at_frames = (
        f", each known to a frame ({1e3 * frame:.3g} ms)" if len(np.unique(values, axis=0)) > 1 else ""
    )
    placed = ", instants known apart from the frames" if recording.drive_time_s is not None else at_frames
    return [*lines, _switching(recording, time, values) + placed]


def _levels(channel: DriveChannel, signal: np.ndarray) -> str:
    levels = np.unique(signal)
    if len(levels) == 1:
        return f"{channel.shown(levels[0])} throughout"
    if len(levels) <= _MOST_SHOWN:
        return f"{', '.join(f'{level:.6g}' for level in levels[:-1])} and {channel.shown(levels[-1])}"
    return f"from {levels[0]:.6g} to {channel.shown(levels[-1])}, {len(levels)} values"


def _switching(recording: Recording, time: np.ndarray, values: np.ndarray) -> str:
    changes = time[1 + np.flatnonzero(np.any(np.diff(values, axis=0) != 0, axis=1))]
    if len(changes) == 0:
        return "never changes"
    cycle = cycle_of(recording)
    if cycle is not None:
        cycles = cycle.count(recording.time_s)
        return f"repeats at {1 / cycle.period:.4g} Hz, {cycles:.3g} cycles from {cycle.start:.5g} s on"
    if len(changes) <= _MOST_SHOWN:
        return f"changes at {', '.join(f'{instant:.5g}' for instant in changes)} s"
    return f"changes {len(changes)} times between {changes[0]:.5g} and {changes[-1]:.5g} s, without a period"


def _markers(recording: Recording) -> str:
    if recording.markers is None:
        return "none recorded, only the angle"
    unit = "m" if recording.marker_unit == "m" else "px (y down)"
    return f"{', '.join(recording.marker_names)} in {unit}"


def _start(recording: Recording) -> str:
    header = recording.metadata
    state = header.get("initial_state", "rest").replace("_", " ")
    drive_start = recording.drive()[0][0] if recording.driven else recording.time_s[0]
    begins = float(min(recording.time_s[0], drive_start))
    text = f"from {state} at {header.get('initial_time_s', f'{begins:.6g}')} s"
    if "initial_load_factor" in header:
        text += f", under {header['initial_load_factor']} times all loads"
    return text
