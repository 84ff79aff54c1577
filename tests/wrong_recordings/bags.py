# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""MCAP files and bags of a few messages, one for each kind of fault."""

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from hasel_common.topics import DRIVE, MEASURED, STATE
from hasel_recording import McapRecorder, Recording, read_recording, write_recording
from hasel_recording.ros_messages import bending_angle_message
from mcap.records import Chunk
from mcap.stream_reader import StreamReader
from mcap.writer import Writer

ANGLE = bending_angle_message(0.1)
KIND = "hasel_interfaces/msg/BendingAngle"
SUPPLY = {
    "muscle": ["upper", "lower"],
    "measured_voltage": [math.nan] * 2,
    "current": [math.nan] * 2,
    "mode": 2,
    "fault_code": 0,
    "fault_text": "",
    "grounded": False,
    "ground": 0,
    "commander": "",
    "interlock": [0, 0],
    "emergency_stop_holders": [],
    **dict.fromkeys(("maximum_voltage", "slew_rate", "trip_current", "heartbeat_timeout"), math.nan),
}


def _state(*voltage: float) -> dict:
    return SUPPLY | {"commanded_voltage": list(voltage)}


def _drive(**values: float) -> dict:
    return {"channel": list(values), "value": list(values.values())}


MESSAGES: list[list[tuple]] = [
    [],
    [("/hasel/bending/measurd", ANGLE, 1, KIND)],
    [(MEASURED, ANGLE, 1), ("/hasel/states", _state(0, 0), 1, "hasel_interfaces/msg/SupplyState")],
    [(MEASURED, {"data": 0.1}, 1, "std_msgs/msg/Float64")],
    [(f"/rig{rig}/bending/measured", ANGLE, rig, KIND) for rig in (1, 2)],
    [(MEASURED, ANGLE, stamp) for stamp in (10, 30, 20)],
    [(STATE, _state(0, 0), 15), *((MEASURED, ANGLE, stamp) for stamp in (0, 10, 20))],
    [(STATE, _state(0, 0), 15), (MEASURED, ANGLE, 10)],
    [
        (STATE, _state(3000, 0), 0),
        (STATE, _state(math.nan, math.nan), 20),
        *((MEASURED, ANGLE, stamp) for stamp in (0, 10, 20, 30)),
    ],
    [(STATE, _state(0, 0), 1), (STATE, _state(0, math.nan), 2), (MEASURED, ANGLE, 2)],
    [(STATE, _state(0, 0), 1), (STATE, _state(0, 0, 0), 2), (MEASURED, ANGLE, 3)],
    [(DRIVE, _drive(pressure_chamber_mbar=1.0), 1), (MEASURED, ANGLE, 2)],
    [(DRIVE, _drive(torque_fin_nm=1.0), 1), (MEASURED, ANGLE, 2)],
]


def _damaged(content: bytes, path: Path) -> Iterator[bytes]:
    """A whole file with each kind of damage."""
    with path.open("rb") as file:
        chunk = [each for each in StreamReader(file, emit_chunks=True).records if isinstance(each, Chunk)][2]
    middle = content.index(chunk.data) + len(chunk.data) // 2
    yield content[: len(content) // 2]
    yield content[:middle] + bytes([content[middle] ^ 0xFF]) + content[middle + 1 :]
    yield b""
    yield b"no recording at all"


def _own_writer(path: Path, encoding: str, schema: tuple[str, bytes], data: bytes) -> None:
    with path.open("wb") as file:
        writer = Writer(file)
        writer.start()
        number = writer.register_schema(KIND, *schema)
        writer.add_message(writer.register_channel(MEASURED, encoding, number), 1, data, 1)
        writer.finish()


def inputs(folder: Path) -> Iterator[Callable]:
    """Each a call that reads one faulty file or folder."""
    paths = (folder / str(number) / "run.mcap" for number in range(1000))

    def fresh() -> Path:
        path = next(paths)
        path.parent.mkdir()
        return path

    for messages in MESSAGES:
        path = fresh()
        with McapRecorder(path) as recorder:
            for message in messages:
                recorder.write(*message)
        yield lambda path=path: read_recording(path)
    time = np.arange(240) / 120
    upper = np.where(time % 0.5 < 0.25, 3500.0, 0.0)
    whole = fresh()
    angle = 0.1 * np.sin(12 * time)
    write_recording(Recording("run", time, angle, np.column_stack([upper, 0 * upper])), whole)
    content = whole.read_bytes()
    for damaged in _damaged(content, whole):
        path = fresh()
        path.write_bytes(damaged)
        yield lambda path=path: read_recording(path)
    for encoding, schema, data in (
        ("json", ("jsonschema", b"{}"), b"{}"),
        ("cdr", ("ros2msg", b"no definition ]["), b"\0\1\0\0"),
        ("cdr", ("ros2msg", b"float64 other"), b"\0\1\0\0" + bytes(8)),
        ("cdr", ("ros2msg", b"float64 sin_theta"), b"\0\1\0\0"),
    ):
        path = fresh()
        _own_writer(path, encoding, schema, data)
        yield lambda path=path: read_recording(path)
    for names, metadata in (
        (("a.mcap", "b.mcap"), None),
        (("a.mcap",), "nothing: here\n"),
        (("a.mcap",), "rosbag2_bagfile_information: {relative_file_paths: [a.mcap, b.mcap]}\n"),
        (("a.db3",), None),
    ):
        bag = folder / f"bag{sum(1 for _ in folder.glob('bag*'))}" / "bag"
        bag.mkdir(parents=True)
        for name in names:
            (bag / name).write_bytes(content)
        if metadata is not None:
            (bag / "metadata.yaml").write_text(metadata)
        yield lambda bag=bag: read_recording(bag)
    (folder / "run.csv").write_text("time_s,sin_theta\n0,0.1\n1,0.1\n")
    path = fresh()
    with McapRecorder(path) as recorder:
        recorder.write(MEASURED, ANGLE, 1)
    yield lambda: read_recording(folder / "run.csv", drive=path)
    yield lambda: read_recording(folder / "run.csv", drive=folder / "missing.mcap")
