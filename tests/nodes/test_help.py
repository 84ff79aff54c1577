# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`--help` of a node tells its parameters and starts nothing; the driver's would open the high voltage's port."""

import subprocess
import sys

import pytest

_PROGRAM = """
import sys, rclpy
def init(*_, **__): raise SystemExit("started")
rclpy.init = init
sys.argv = ["node", *{arguments}]
from {module} import {function}
{function}()
"""


def start(entry: str, *arguments: str) -> subprocess.CompletedProcess:
    """Call the executable's entry, module:function, in a fresh interpreter in which no node can start."""
    module, _, function = entry.partition(":")
    program = _PROGRAM.format(arguments=list(arguments), module=module, function=function)
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False
    )


@pytest.mark.parametrize(
    ("entry", "parameter"),
    [
        ("hasel_driver.start:driver_node", "port:="),
        ("hasel_tracker.tracker_commands:tracker_node", "source:="),
        ("hasel_sim.live.start_simulator:main", "model:=swimmer"),
        ("hasel_sysid.live.start_sysid:main", "window:=5.0"),
        ("hasel_bringup.bringup_commands:virtual_rig", "hidden:="),
        ("hasel_bringup.bringup_commands:recorder", "folder:=recordings"),
        ("hasel_bringup.bringup_commands:virtual_camera", "hidden:=[random]"),
        ("hasel_bringup.bringup_commands:replay", "--rate"),
        ("hasel_driver.virtual.virtual_supply:main", "--link"),
    ],
)
def test_help_starts_nothing(entry, parameter):
    """Usage and parameters with defaults, exit code 0; with a slip of the pen exit code 2."""
    done = start(entry, "--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("usage: ")
    assert parameter in done.stdout
    assert start(entry, "--hepl").returncode == 2


def test_the_node_is_what_starts_without_it():
    """The guard of the tests above does see a node that starts."""
    assert start("hasel_sim.live.start_simulator:main").stderr == "started\n"
