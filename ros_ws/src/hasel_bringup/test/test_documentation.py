# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The page's tables say what the code does."""

import re
from pathlib import Path

import pytest
from hasel_bringup.bringup_parameters import RECORDER, VIRTUAL_BODY, VIRTUAL_CAMERA

PACKAGE = Path(__file__).resolve().parents[1]
DOCS = Path(__file__).resolve().parents[4] / "docs"
PAGE = (DOCS / "how_to/launch.md").read_text(encoding="utf-8")
LAUNCH_FILES = sorted((PACKAGE / "launch").glob("*.launch.py"))
SHARED = PACKAGE / "hasel_bringup" / "launching.py"


def test_commands_are_listed():
    """Exactly the executables of the package."""
    executables = re.findall(r'"(\w+) = hasel_bringup', (PACKAGE / "setup.py").read_text(encoding="utf-8"))
    assert executables
    assert sorted(re.findall(r"^\| `(\w+)` \| [^|]* \|$", PAGE, flags=re.M)) == sorted(executables)


@pytest.mark.parametrize(
    ("node", "table"),
    [("recorder", RECORDER), ("virtual_camera", VIRTUAL_CAMERA), ("virtual_rig", VIRTUAL_BODY)],
)
def test_parameters_are_those_of_the_nodes(node, table):
    """Every parameter has its row with default, unit and meaning, and no row is about another."""
    rows = re.findall(rf"^\| {node} \| `(\w+)` \| (\S+) \| (\S*) ?\| (.*) \|$", PAGE, flags=re.M)
    expected = [
        (p.name, "none" if p.default == [""] else f"`{p.default}`", p.unit, p.description) for p in table
    ]
    assert rows == expected


@pytest.mark.parametrize("path", [*LAUNCH_FILES, SHARED], ids=lambda path: path.name)
def test_arguments_are_those_of_the_launch_files(path):
    """In their order, with the meaning that --show-args tells."""
    declared = re.findall(
        r'DeclareLaunchArgument\(\s*"(\w+)".*?description="([^"]+)"',
        path.read_text(encoding="utf-8"),
        flags=re.S,
    )
    name = "all" if path == SHARED else f"`{path.name}`"
    rows = re.findall(rf"^\| {name} \| `(\w+)` \| .* \| (.*) \|$", PAGE, flags=re.M)
    assert rows == declared
    assert len(re.findall(rf"^\| {name} \| [^`|]", PAGE, flags=re.M)) == (path != SHARED)
