# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
FIND_TOOLS = ROOT / "setup" / "find_tools.sh"


def put(folder: Path, name: str, script: str = "exit 0") -> None:
    """Put an executable shell script into a folder."""
    (folder / name).write_text(f"#!/bin/sh\n{script}\n")
    (folder / name).chmod(0o755)


def python_of_version(version: str) -> str:
    """Return a script that does what Python does when asked for its version, and succeeds at all else."""
    run = f'exec "{sys.executable}" -S -c'
    pretend = f"import sys; sys.version_info = ({version.replace('.', ', ')}, 0, 'final', 0)"
    return f'case "$2" in *version*) {run} "{pretend}; $2";; *Python.h*|*venv*) exit 0;; esac; exit 9'


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A folder to be the whole PATH, with every tool in it."""
    for tool in ("cc", "c++", "cmake"):
        put(tmp_path, tool)
    put(tmp_path, "python3.11", python_of_version("3.11"))
    return tmp_path


def find_tools(path: Path, **environment: str) -> subprocess.CompletedProcess:
    """Run the checker with this folder alone as PATH."""
    return subprocess.run(
        ["/bin/sh", str(FIND_TOOLS)],
        env={"PATH": str(path), "_ROS_WHEELS_BOOTSTRAP_COMPLETE": "1", **environment},
        capture_output=True,
        text=True,
        check=False,
    )


def test_complete_machine_gives_its_python(path):
    """Where nothing is missing the Python to use is printed and nothing else."""
    result = find_tools(path)
    assert (result.returncode, result.stderr) == (0, "")
    assert result.stdout.strip() == str(path / "python3.11")


@pytest.mark.parametrize(
    ("tool", "message", "package"),
    [
        ("cc", "No C compiler (cc) was found", "build-essential"),
        ("c++", "No C++ compiler (c++) was found", "build-essential"),
        ("cmake", "No cmake was found", "cmake"),
        (
            "python3.11",
            "Found no Python, but Python 3.10, 3.11 or 3.12 is needed",
            "python3.11 python3.11-venv",
        ),
    ],
)
def test_missing_tool_is_one_sentence(path, tool, message, package):
    """A missing tool is named in one line together with the apt package that brings it."""
    (path / tool).unlink()
    result = find_tools(path)
    assert result.returncode == 1
    assert result.stdout == ""
    assert result.stderr.startswith(message)
    assert f"sudo apt install {package}" in result.stderr
    assert result.stderr.count("\n") == 1


def test_wrong_python_says_which_was_found(path):
    """A Python that is too new is named with its version."""
    (path / "python3.11").unlink()
    put(path, "python3", 'case "$2" in *platform*) echo Python 3.13.0;; *) exit 1;; esac')
    result = find_tools(path)
    assert result.stderr.startswith("Found Python 3.13.0, but Python 3.10, 3.11 or 3.12 is needed")


@pytest.mark.parametrize(
    ("lacking", "message"),
    [("ensurepip", "has no venv module"), ("Python.h", "has no header files (Python.h)")],
)
def test_incomplete_python(path, lacking, message):
    """A Python without venv or without headers names the package of that very version."""
    put(path, "python3.11", f'case "$2" in *{lacking}*) exit 1;; esac; {python_of_version("3.11")}')
    result = find_tools(path)
    assert message in result.stderr
    assert "sudo apt install python3.11-" in result.stderr


@pytest.mark.parametrize(
    ("present", "chosen"),
    [
        (["3.10", "3.11", "3.12"], "3.11"),
        (["3.10", "3.12"], "3.12"),
        (["3.10"], "3.10"),
    ],
)
def test_preferred_python(path, present, chosen):
    """Of several Pythons 3.11 comes first, then 3.12, then 3.10."""
    (path / "python3.11").unlink()
    for version in present:
        put(path, f"python{version}", python_of_version(version))
    assert find_tools(path).stdout.strip() == str(path / f"python{chosen}")


def test_command_that_does_not_run_is_passed_over(path):
    """A python3.11 that cannot start (a version manager's shim without that version) is not chosen."""
    put(path, "python3.11", "exit 127")
    put(path, "python3.12", python_of_version("3.12"))
    assert find_tools(path).stdout.strip() == str(path / "python3.12")


def test_sourced_ros_uses_its_python_and_needs_colcon(path):
    """Where ROS 2 Jazzy is sourced, the Python it was built for is used and colcon must be there."""
    put(path, "python3.12", python_of_version("3.12"))
    assert "python3-colcon-common-extensions" in find_tools(path, ROS_DISTRO="jazzy").stderr
    put(path, "colcon")
    assert find_tools(path, ROS_DISTRO="jazzy").stdout.strip() == str(path / "python3.12")


def test_make_stops_at_the_sentence(path, tmp_path):
    """`make build` in a fresh clone says the same sentence and goes no further."""
    for tool in ("make", "bash", "sed", "dirname", "cat", "sh"):
        (path / tool).symlink_to(shutil.which(tool))
    (path / "cmake").unlink()
    clone = tmp_path / "clone"
    shutil.copytree(ROOT / "setup", clone / "setup")
    for name in ("Makefile", "requirements.txt"):
        shutil.copy(ROOT / name, clone / name)
    command = [path / "make", "build"]
    result = subprocess.run(
        command, cwd=clone, env={"PATH": str(path)}, capture_output=True, text=True, check=False
    )
    assert result.returncode != 0
    assert result.stderr.startswith("No cmake was found")
    assert not (clone / ".venv").exists()
