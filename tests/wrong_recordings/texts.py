# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""CSV files of a few lines, one for each kind of fault, and the files beside them that they need."""

from collections.abc import Iterator
from pathlib import Path

from hasel_recording import read_recording, read_recordings
from hasel_recording.csv_columns import parse_map

Files = dict[str, str | bytes]

TOP = "time_s,voltage_upper_v,sin_theta\n"
ROW = "0,5000,0.1\n"
LONG = "time_s,sin_theta\n" + "".join(f"{0.1 * n:.1f},0.{n:02d}\n" for n in range(80))
SWITCHED = TOP + "".join(f"{n},{5000 * (n // 5 % 2)},0.{n}\n" for n in range(40))


def _without(rows: range) -> str:
    lines = SWITCHED.splitlines(keepends=True)
    return "".join(line for number, line in enumerate(lines) if number - 1 not in rows)


FILE: list[str | bytes] = [
    "",
    b"\x89\xff\x00",
    "0,5000,0.1\n0.01,5000,0.2\n",
    "time_s,sin_theta\n",
    "Format Version,1.23,Take Name,Take 1\n",
    "scorer,DLC_resnet50,DLC_resnet50\n",
    "NO_OF_FRAMES\t100\n",
    TOP + '0,"5000,0.1\n',
    TOP + "0,5000\n",
    TOP + ROW + ROW,
    "#volts_per_mbar: 10\n#volts_per_bar: 1\n" + TOP + ROW,
    "#volts_per_torr: 10\n" + TOP + ROW,
    "#volts_per_mbar: ten\n" + TOP + ROW,
    "#drive: hv.csv\n" + TOP + ROW,
]
COLUMNS = [
    "time_s,sin_teta\n0,0.1\n",
    "time_s,temperature\n0,21\n",
    "frame,sin_theta\n1,0.1\n",
    "time_s,head_x_m,sin_theta\n0,1,0.1\n",
    "time_s,time_s,sin_theta\n0,0,0.1\n",
    "time_s,angle_deg\n0,1\n",
    "time_s,temperature,sin_theta\n0,21,0.1\n",
    "time_s,pressure_mbar,sin_theta\n0,1,0.1\n",
    "time_s,pressure_chamber_torr,sin_theta\n0,1,0.1\n",
    "time_s,voltage_upper_v,voltage_upper_kv,sin_theta\n0,1,0.001,0.1\n",
    TOP + "0,O,0.1\n",
    TOP + "0,,0.1\n",
    TOP + "0,nan,0.1\n",
    TOP + '0,"1,100",0\n1,"1,200",1\n',
    "time_s,sin_theta\n0,nan\n0.1,\n",
]
TIME = [
    TOP + "0,0,0.1\n0,1,0.1\n0,2,0.1\n1,3,0.1\n1,4,0.1\n",
    TOP + "5,0,0.1\n5.1,1,0.1\n5.2,2,0.1\n0,3,0.1\n",
    TOP + "5,0,0.1\n5.1,1,0.1\n5.3,2,0.1\n5.2,3,0.1\n",
    TOP + "".join(f"{(86399.98 + 0.01 * n) % 86400:.2f},{n},0.1\n" for n in range(5)),
]
DRIVE = [
    TOP + "0,5000,0.1\n0.1,,0.2\n",
    _without(range(9, 11)),
    TOP + "0,0,0.1\n1,0,0.1\n2,0,0.2\n5,9,0.2\n6,9,0.1\n",
]
MAPS = [
    "time",
    "time=t,time=u",
    "time=t_im",
    "time=bogus",
    "effort_upper=voltage_upper_v",
]
DRIVES: Files = {
    "late.csv": "time_s,pressure_chamber_mbar\n0.2,250\n0.3,0\n",
    "another_day.csv": "time_s,pressure_chamber_mbar\n70,250\n",
    "early.csv": "time_s,pressure_chamber_mbar\n0,0\n1,250\n",
    "valve.csv": "t,Druck\n0,0\n",
    "no_drive.csv": "time_s,temperature\n0,21\n",
}


def inputs(folder: Path) -> Iterator:
    """Each a call that reads one faulty file."""
    for number, text in enumerate((*FILE, *COLUMNS, *TIME, *DRIVE)):
        path = folder / str(number) / "run.csv"
        path.parent.mkdir()
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        yield lambda path=path: read_recording(path)
    path = folder / "run.csv"
    path.write_text("t_ms,voltage_upper_v,sin_theta\n0,5000,0.1\n")
    for mapping in MAPS:
        yield lambda mapping=mapping: read_recording(path, parse_map(mapping))
    (folder / "long" / "run.csv").parent.mkdir()
    (folder / "long" / "run.csv").write_text(LONG)
    for name, text in DRIVES.items():
        (folder / name).write_text(text)
        yield lambda name=name: read_recording(folder / "long" / "run.csv", drive=folder / name)
    yield lambda: read_recordings([path] * 3, drives=[path] * 2)
    yield lambda: read_recordings([])
    (folder / "run.xlsx").write_text("x")
    for name in ("run.xlsx", "runn.csv", "nothing.csv"):
        yield lambda name=name: read_recording(folder / name)
