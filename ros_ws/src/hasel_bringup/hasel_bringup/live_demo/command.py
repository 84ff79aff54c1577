"""`ros2 run hasel_bringup live_demo`: the whole rig live without hardware, and an effect that it has to find."""

import argparse
import os
import signal
import sys
from pathlib import Path

from rich.console import Console

from hasel_bringup.demo.processes import Processes
from hasel_bringup.errors import BringupError
from hasel_bringup.live_demo.commands import Commands
from hasel_bringup.live_demo.nodes import start_nodes
from hasel_bringup.live_demo.rig import Rig
from hasel_bringup.live_demo.session import Session


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return _run(options)
    except BringupError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(
            "Interrupted: the nodes have ended, what was recorded is complete up to there.", file=sys.stderr
        )
        return 0


def _run(options: argparse.Namespace) -> int:
    folder = _fresh(options.output)
    console = Console(highlight=False)
    domain = None if options.attach else 1 + os.getpid() % 100
    environment = {}
    if domain is not None:
        environment = {"ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        os.environ.update(environment)
        console.print(
            f"A ROS domain of its own, so that no real rig hears it: ROS_DOMAIN_ID={domain} "
            "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ros2 topic echo /hasel/error",
            soft_wrap=True,
        )
    with Processes(folder / "logs", environment) as processes:
        if not options.attach:
            start_nodes(processes, folder, options.hidden, options.seed)
        rig = Rig(processes.check, domain)
        try:
            commands = Commands(processes, console)
            Session(rig, commands, folder, console).run(options.runs)
        finally:
            rig.close()
    return 0


def _fresh(output: Path) -> Path:
    """A folder of this name that has nothing in it yet: numbered where there is one."""
    number, folder = 1, output
    while folder.exists() and any(folder.iterdir()):
        number += 1
        folder = output.with_name(f"{output.name}_{number}")
    folder.mkdir(parents=True, exist_ok=True)
    return folder.resolve()
