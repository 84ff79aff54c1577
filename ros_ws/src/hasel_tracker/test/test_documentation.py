# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page's tables say what the code does."""

import re
from pathlib import Path

import pytest
from hasel_common import topics
from hasel_tracker import tracker_commands
from hasel_tracker.tracker_parameters import PARAMETERS

PACKAGE = Path(__file__).resolve().parents[1]
DOCS = Path(__file__).resolve().parents[4] / "docs"
PAGE = (DOCS / "how_to" / "camera.md").read_text(encoding="utf-8")
NODE = (PACKAGE / "hasel_tracker" / "tracker_node.py").read_text(encoding="utf-8")


def rows(heading: str) -> list[list[str]]:
    """Cells of the table whose first heading is this."""
    lines = PAGE.splitlines()
    start = next(number for number, line in enumerate(lines) if line.startswith(f"| {heading} |"))
    table = []
    for line in lines[start + 2 :]:
        if not line.startswith("|"):
            break
        table.append([cell.strip() for cell in line.strip("|").split("|")])
    return table


def test_parameters_are_listed_as_they_are():
    """Every parameter is in the table with its default, its meaning, and whether it may change; no other is."""
    expected = [
        [
            f"`{each.name}`{' ✎' * each.changeable}",
            f"`{each.default}`",
            each.description + (f" [{each.unit}]" if each.unit else ""),
        ]
        for each in PARAMETERS
    ]
    assert rows("parameter") == expected


def test_topics_and_services_are_listed():
    """The tables name exactly what the node publishes and offers."""
    constants = {"MEASURED": topics.MEASURED, "DIAGNOSTICS": topics.DIAGNOSTICS}
    published = re.findall(r"publisher\(self, \w+, (\S+), Role", NODE)
    published += ["DIAGNOSTICS"] * ("Diagnostics(self, " in NODE)
    offered = re.findall(r'create_service\(\w+, "([^"]+)"', NODE)
    assert {row[0].strip("`") for row in rows("topic")} == {
        constants.get(name, name.strip('"')) for name in published
    }
    assert {row[0].strip("`") for row in rows("service")} == set(offered)


def test_commands_are_listed():
    """Every executable of the package is in the table of commands."""
    executables = re.findall(r'"(\w+) = hasel_tracker', (PACKAGE / "setup.py").read_text(encoding="utf-8"))
    listed = " ".join(row[0] for row in rows("command"))
    assert executables
    assert [name for name in executables if not re.search(rf"`{name}\b", listed)] == []


@pytest.mark.parametrize("name", ["track", "calibrate"])
def test_options_named_in_the_readme_exist(name, capsys):
    """Options shown beside a command on one line are options of that command."""
    helps = []
    for arguments in (["--help"], ["colour", "--help"], ["board", "--help"], ["distance", "--help"]):
        with pytest.raises(SystemExit):
            getattr(tracker_commands, f"{name}_parser")().parse_args(
                arguments if name == "calibrate" else ["--help"]
            )
        helps.append(capsys.readouterr().out)
    shown = re.findall(rf"hasel_tracker {name}\b([^\n]*)|`{name} ([^`]*)`", PAGE)
    options = {option for line in shown for option in re.findall(r"--[a-z-]+", " ".join(line))}
    assert [option for option in options if not any(option in text for text in helps)] == []
