# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The pages say what the laboratory does."""

import re
from pathlib import Path

import pytest
from hasel_tracker_lab import lab_commands as tracker_lab_commands
from hasel_tracker_lab.bench.accuracy import CONDITIONS
from hasel_tracker_lab.bench.robustness import CASES

PACKAGE = Path(__file__).resolve().parents[1]
DOCS = Path(__file__).resolve().parents[4] / "docs"
PAGE = "\n".join(
    (DOCS / page).read_text(encoding="utf-8") for page in ("how_to/camera.md", "results/tracker.md")
)


def first_cells(heading: str) -> list[str]:
    """First cells of the rows of the table whose first heading is this."""
    lines = PAGE.splitlines()
    start = lines.index(next(line for line in lines if line.startswith(f"| {heading} |"))) + 2
    rows = [line for line in lines[start:] if line.startswith("|")]
    end = next((n for n, line in enumerate(lines[start:]) if not line.startswith("|")), len(rows))
    return [line.strip("|").split("|")[0].strip() for line in rows[:end]]


def test_commands_are_listed():
    """Every executable of the package, and no other, is in its table of commands."""
    executables = re.findall(
        r'"(\w+) = hasel_tracker_lab', (PACKAGE / "setup.py").read_text(encoding="utf-8")
    )
    listed = [re.match(r"`(\w+)", cell)[1] for cell in first_cells("command of the laboratory")]
    assert sorted(listed) == sorted(executables)


@pytest.mark.parametrize("name", ["render", "bench"])
def test_options_named_on_the_pages_exist(name, capsys):
    """Options shown beside a command on one line are options of that command."""
    with pytest.raises(SystemExit):
        getattr(tracker_lab_commands, f"{name}_parser")().parse_args(["--help"])
    said = capsys.readouterr().out
    shown = re.findall(rf"hasel_tracker_lab {name}\b([^\n]*)|`{name} ([^`]*)`", PAGE)
    options = {option for line in shown for option in re.findall(r"--[a-z-]+", " ".join(line))}
    assert options
    assert [option for option in options if option not in said] == []


def test_measured_tables_have_a_row_for_everything_measured():
    """Each condition and each case of the benchmark has its row."""
    assert first_cells("condition") == [*(each.name for each in CONDITIONS), "CSRT, MJPEG quality 75"]
    assert first_cells("case") == list(CASES)
