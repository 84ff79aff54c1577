# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The tutorial's commands print what stands there."""

import re
import shlex
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "tutorial" / "first_answer.md").read_text(encoding="utf-8")
SHOWN = {
    command.split()[0]: (command, text.splitlines())
    for command, text in re.findall(r"```\n\$ ros2 run hasel_sysid (.*)\n((?:.*\n)*?)```", PAGE)
}


def printed(command: str, folder: Path) -> list[str]:
    """The lines of a command of the page, run in a shell in the repository."""
    command = re.sub(r" --output \S+", "", command) + f" --output {shlex.quote(str(folder))}" * (
        "check" not in command
    )
    line = f"bin/ros2 run hasel_sysid {command}"
    done = subprocess.run(["bash", "-c", line], cwd=ROOT, capture_output=True, text=True, timeout=900)
    return done.stdout.splitlines()


@pytest.mark.parametrize(
    "name", ["check", "compare", pytest.param("improve", marks=[pytest.mark.slow, pytest.mark.timeout(900)])]
)
def test_the_page_shows_what_is_printed(name, tmp_path):
    """Line by line, in order."""
    command, lines = SHOWN[name]
    said = iter(printed(command, tmp_path))
    assert lines
    assert [line for line in lines if line not in said] == []
