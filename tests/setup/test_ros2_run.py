# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
import os
import shutil
import signal
import subprocess
import time
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ROS2_RUN = ROOT / "bin" / "ros2-run"
UNSOURCED = {"PATH": "/usr/bin:/bin", "HOME": os.environ.get("HOME", "/")}


@pytest.fixture
def prefix(tmp_path: Path) -> Path:
    """An ament prefix with one package, `rig`, of two executables and a file that is none."""
    index = tmp_path / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "rig").write_text("")
    folder = tmp_path / "lib" / "rig"
    folder.mkdir(parents=True)
    (folder / "say").write_text('#!/bin/sh\nprintf "%s|" "$@"\nexit 3\n')
    (folder / "wait").write_text(
        '#!/bin/sh\ntrap "echo stopped; exit 7" INT\necho $$\nwhile :; do sleep 0.05; done\n'
    )
    for path in folder.iterdir():
        path.chmod(0o755)
    (folder / "notes.txt").write_text("")
    return tmp_path


def ros2_run(*arguments: str, prefix: Path | None = None) -> subprocess.CompletedProcess:
    """Run bin/ros2-run in an environment in which nothing was sourced."""
    environment = UNSOURCED | ({"AMENT_PREFIX_PATH": str(prefix)} if prefix else {})
    return subprocess.run(
        [ROS2_RUN, *arguments], env=environment, cwd="/", capture_output=True, text=True, check=False
    )


def test_arguments_and_exit_code_pass_through(prefix):
    """The executable gets its arguments unchanged, and its exit code is ours."""
    result = ros2_run("rig", "say", "a b", "--ros-args", "", "-p", "x:=1", prefix=prefix)
    assert (result.stdout, result.returncode) == ("a b|--ros-args||-p|x:=1|", 3)


def test_signals_reach_the_executable(prefix):
    """The executable takes the place of the script, process id included, so Ctrl-C stops it properly."""
    environment = UNSOURCED | {"AMENT_PREFIX_PATH": str(prefix)}
    process = subprocess.Popen([ROS2_RUN, "rig", "wait"], env=environment, stdout=subprocess.PIPE, text=True)
    assert int(process.stdout.readline()) == process.pid
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    assert process.communicate(timeout=10)[0] == "stopped\n"
    assert process.returncode == 7


def test_works_from_anywhere_without_sourcing(tmp_path):
    """An executable of the workspace runs from another folder, through a link, with nothing sourced."""
    link = tmp_path / "ros2-run"
    link.symlink_to(ROS2_RUN)
    result = subprocess.run(
        [link, "hasel_recording", "convert", "--help"],
        env=UNSOURCED,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout.startswith("usage: convert")


def test_unknown_package_names_the_nearest():
    """A misspelt package is answered with the package that was meant."""
    result = ros2_run("hasel_recordin", "convert")
    assert result.stderr == "There is no package 'hasel_recordin': did you mean hasel_recording?\n"
    assert result.returncode == 1


def test_unknown_executable_lists_those_there_are(prefix):
    """A misspelt executable is answered with the list; files that are not executable are not in it."""
    result = ros2_run("rig", "sya", prefix=prefix)
    assert result.stderr == "Package rig has no executable 'sya': it has say, wait.\n"


def test_package_without_executables():
    """A package of messages has none."""
    assert (
        ros2_run("std_msgs", "talker").stderr == "Package std_msgs has no executable 'talker': it has none.\n"
    )


def test_too_few_arguments():
    """Without an executable the usage is shown."""
    assert ros2_run("hasel_recording").stderr.startswith("usage: bin/ros2-run PACKAGE EXECUTABLE")


def test_workspace_not_built(tmp_path):
    """Before the first build the remedy is named."""
    for folder in ("bin", "setup"):
        shutil.copytree(ROOT / folder, tmp_path / folder, ignore=shutil.ignore_patterns("__pycache__"))
    result = subprocess.run(
        [tmp_path / "bin" / "ros2-run", "a", "b"], capture_output=True, text=True, check=False
    )
    assert result.stderr == "The workspace is not built yet: run `make build` first.\n"
