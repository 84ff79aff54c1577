"""`--help` of a node tells its parameters and starts nothing; the driver's would open the high voltage's port."""

import subprocess
import sys

import pytest

_PROGRAM = """
import sys, rclpy
def init(*_, **__): raise SystemExit("started")
rclpy.init = init
sys.argv = ["node", *{arguments}]
from {module} import main
main()
"""


def start(module: str, *arguments: str) -> subprocess.CompletedProcess:
    """Call the executable's entry in a fresh interpreter in which no node can start."""
    program = _PROGRAM.format(arguments=list(arguments), module=module)
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=False
    )


@pytest.mark.parametrize(
    ("module", "parameter"),
    [
        ("hasel_driver.start_driver", "port:="),
        ("hasel_tracker.start_tracker", "source:="),
        ("hasel_sim.start_simulator", "model:=swimmer"),
        ("hasel_sysid.start_sysid", "window:=5.0"),
        ("hasel_bringup.virtual_rig.command", "hidden:="),
        ("hasel_bringup.replay.command", "--rate"),
        ("hasel_driver.virtual_supply", "--link"),
    ],
)
def test_help_starts_nothing(module, parameter):
    """Usage and parameters with defaults, exit code 0; with a slip of the pen exit code 2."""
    done = start(module, "--help")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.startswith("usage: ")
    assert parameter in done.stdout
    assert start(module, "--hepl").returncode == 2


def test_the_node_is_what_starts_without_it():
    """The guard of the tests above does see a node that starts."""
    assert start("hasel_sim.start_simulator").stderr == "started\n"
