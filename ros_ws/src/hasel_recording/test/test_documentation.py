# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page's tables are those of the code."""

import re
from pathlib import Path

from hasel_common.topics import DRIVE, MEASURED, SIMULATED, STATE, TOPIC_TYPES
from hasel_recording.csv_columns import MARKER_UNITS, THETA_UNITS, TIME_UNITS
from hasel_recording.drive_channel import UNITS
from hasel_recording.recording import KNOWN_KEYS

DOCS = Path(__file__).resolve().parents[4] / "docs"
PAGE = (DOCS / "how_to/recordings.md").read_text(encoding="utf-8")


def rows(first: str) -> list[tuple[str, ...]]:
    """The cells of the table whose first column has this title."""
    table = PAGE.split(f"| {first} |", 1)[1].split("\n\n", 1)[0]
    return [tuple(cell.strip() for cell in line.strip("| ").split(" | ")) for line in table.splitlines()[2:]]


def test_columns_and_units():
    """Every quantity has its row with all units that are understood."""
    units = {name: told.split(", ") for name, told, _ in rows("column")}
    assert units.pop("`sin_theta`") == ["1"]
    assert units.pop("`time_<unit>`") == list(TIME_UNITS)
    assert units.pop("`theta_<unit>`") == list(THETA_UNITS)
    assert units.pop("`<marker>_x_<unit>`, `<marker>_y_<unit>`") == list(MARKER_UNITS)
    assert units == {f"`{quantity}_<channel>_<unit>`": list(known) for quantity, known in UNITS.items()}


def test_header_lines():
    """Every header line that means something has its row."""
    assert dict(rows("header line")) == {f"`{key}`": said for key, said in KNOWN_KEYS.items()}


def test_topics():
    """Topics and types are those that are written."""
    assert [(topic, kind) for topic, kind, _ in rows("topic")] == [
        (f"`{topic}`", f"`{TOPIC_TYPES[topic]}`") for topic in (STATE, DRIVE, MEASURED, SIMULATED)
    ]


def test_example_file_is_read(tmp_path):
    """The file that is shown is a recording; its blank angle is a missing one."""
    from hasel_recording import read_recording

    (text,) = re.findall(r"```\n(#model: swimmer\n.*?)```", PAGE, re.DOTALL)
    (tmp_path / "run.csv").write_text(text)
    run = read_recording(tmp_path / "run.csv")
    assert run.valid.tolist() == [True, False, True]
    assert run.voltage[-1].tolist() == [0, 3500]
