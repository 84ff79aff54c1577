"""Read a run from the messages of an MCAP file."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from hasel_common.names import nearest
from hasel_common.topics import MARKERS, MEASURED, SIMULATED, STATE, TOPIC_TYPES

from hasel_recording.bag import read_bag
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_recording.mcap_drive import StampedDrive, stamped_drive, stamped_messages
from hasel_recording.mcap_file import McapFile
from hasel_recording.mcap_recorder import HEADER_RECORD, TIME_RECORD
from hasel_recording.recording import MARKER_NAMES, Recording
from hasel_recording.stand_in import as_meant


def read_mcap(path: Path) -> Recording:
    """Read one run, sampled at the stamps of the measured angle.

    Frames before the first known drive, and from its end on, are left out with a RecordingWarning.
    """
    file = read_bag(path)
    measured, frame_ns = stamped_messages(file, MEASURED)
    if not measured:
        raise file.missing(MEASURED)
    drive = stamped_drive(file)
    if drive is None and nearest(STATE, set(file.messages) - set(TOPIC_TYPES)):
        raise file.missing(STATE)
    driven = _driven(path, frame_ns, drive)
    origin = time_origin(file, frame_ns[:1] if drive is None else np.append(frame_ns[:1], drive.stamps[:1]))
    markers, unit, names = _markers(file, measured, frame_ns)
    simulated, simulated_ns = stamped_messages(file, SIMULATED)
    metadata = file.metadata.get(HEADER_RECORD, {})
    return Recording(
        name=path.name if path.is_dir() else path.stem,
        path=path,
        metadata=metadata,
        time_s=seconds(frame_ns, origin)[driven],
        sin_theta=_angles(measured)[driven],
        markers=None if markers is None else markers[driven],
        marker_unit=unit,
        marker_names=names,
        **_drive(path, metadata, drive, frame_ns[driven], origin),
        simulated_time_s=seconds(simulated_ns, origin) if simulated else None,
        simulated_sin_theta=_angles(simulated) if simulated else None,
    )


def time_origin(file: McapFile, stamps: np.ndarray) -> int:
    """Return the stamp [ns] that is time 0 of a run: what the file says, else the earliest of `stamps`."""
    said = file.metadata.get(TIME_RECORD, {}).get("time_origin_ns", "")
    return int(said) if said.isdecimal() else int(stamps.min())


def seconds(stamps_ns: np.ndarray, origin_ns: int) -> np.ndarray:
    """Return stamps [ns] as times [s] after the origin."""
    return (stamps_ns - origin_ns) / 1e9


def _angles(messages: list[Any]) -> np.ndarray:
    return np.array([message.sin_theta if message.valid else np.nan for message in messages])


def _driven(path: Path, frame_ns: np.ndarray, drive: StampedDrive | None) -> np.ndarray:
    """Return in which frames the drive is known, [n]; says which are left out."""
    if drive is None:
        return np.ones(len(frame_ns), dtype=bool)
    early = frame_ns < drive.stamps[0]
    late = np.zeros_like(early) if drive.ended_ns is None else frame_ns >= drive.ended_ns
    if (early | late).all():
        raise RecordingError(
            f"{path}: no frame comes while the values on {drive.topic} are known: start the driver before the run."
        )
    for left_out, where in ((early, f"before the first {drive.topic}"), (late, "after the drive's end")):
        if left_out.any():
            warnings.warn(
                f"{path}: {np.count_nonzero(left_out)} frames {where} were left out: what drove the body then is not "
                "known.",
                RecordingWarning,
                stacklevel=4,
            )
    return ~(early | late)


def _drive(
    path: Path, metadata: dict[str, str], drive: StampedDrive | None, frame_ns: np.ndarray, origin: int
) -> dict[str, Any]:
    """Return the drive at the frames and, where it switches between frames, the instants of switching."""
    if drive is None:
        return {}
    channels, values, stand_in = as_meant(drive.channels, drive.values, metadata, str(path))
    drive = StampedDrive(drive.topic, channels, drive.stamps, values)
    sampled = {
        "channels": channels,
        "drive_signal": drive.at(frame_ns),
        "understood": (stand_in,) if stand_in else (),
    }
    changes = drive.changes()
    if np.isin(drive.stamps[changes], frame_ns).all():
        return sampled
    return sampled | {
        "drive_time_s": seconds(drive.stamps[changes], origin),
        "drive_values": drive.values[changes],
    }


def _markers(
    file: McapFile, measured: list[Any], frame_ns: np.ndarray
) -> tuple[np.ndarray | None, str, tuple[str, ...]]:
    """Return the markers [n, m, 2], their unit, metres before pixels, and their names."""
    poses, pose_ns = stamped_messages(file, MARKERS)
    if poses:
        at_frame = {
            stamp: [[p.position.x, p.position.y] for p in m.poses]
            for stamp, m in zip(pose_ns, poses, strict=True)
        }
        lost = [[np.nan, np.nan]] * len(MARKER_NAMES)
        return np.array([at_frame.get(stamp, lost) for stamp in frame_ns]), "m", MARKER_NAMES
    names = tuple(getattr(measured[0], "marker_name", MARKER_NAMES))
    for unit, fields in (("m", ("marker_x_m", "marker_y_m")), ("px", ("marker_x", "marker_y"))):
        coordinates = [[getattr(message, field, ()) for field in fields] for message in measured]
        if {len(axis) for pair in coordinates for axis in pair} - {len(names)}:
            continue
        positions = (
            np.array(coordinates, dtype=float).reshape(len(measured), 2, len(names)).transpose(0, 2, 1)
        )
        if np.isfinite(positions).any():
            return positions, unit, names
    return None, "m", MARKER_NAMES
