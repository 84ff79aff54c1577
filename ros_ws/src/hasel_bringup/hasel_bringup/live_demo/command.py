"""`ros2 run hasel_bringup live_demo`: the whole rig live without hardware, and an effect that it has to find."""

import argparse
import os
import signal
import sys
from pathlib import Path

from hasel_recording.node_usage import user_arguments
from rich.console import Console

from hasel_bringup.demo.processes import Processes
from hasel_bringup.errors import BringupError
from hasel_bringup.live_demo.commands import Commands
from hasel_bringup.live_demo.nodes import start_nodes
from hasel_bringup.live_demo.rig import Rig
from hasel_bringup.live_demo.session import Session
from hasel_bringup.virtual_camera.secret import NOTHING, RANDOM, hideable


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="live_demo",
        description="Virtual supply, driver, camera, tracker, simulator, identification and recorder as nodes: "
        "measure, learn what the model misses, add it to the running simulator, and open the secret.",
    )
    parser.add_argument(
        "--hidden",
        default=RANDOM,
        choices=[RANDOM, NOTHING, *hideable()],
        metavar="NAME",
        help="what the swimmer has beyond the model: an effect, random or none (default: %(default)s)",
    )
    parser.add_argument("--seed", type=int, default=-1, help="of what is random; -1: another one each time")
    parser.add_argument(
        "--output",
        type=Path,
        default=Path("output") / "live_demo",
        metavar="DIR",
        help="(default: %(default)s)",
    )
    parser.add_argument(
        "--runs", type=int, metavar="N", help="only the N shortest runs, without learning anything from them"
    )
    parser.add_argument(
        "--attach", action="store_true", help="use nodes that run already, as virtual.launch.py does"
    )
    return parser


def main() -> int:
    """Command line of `live_demo`; returns the exit code."""
    arguments = _parser().parse_args(user_arguments(sys.argv[1:]))
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        return _run(arguments)
    except BringupError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print(
            "Interrupted: the nodes have ended, what was recorded is complete up to there.", file=sys.stderr
        )
        return 0


def _run(arguments: argparse.Namespace) -> int:
    folder = _fresh(arguments.output)
    console = Console(highlight=False)
    domain = None if arguments.attach else 1 + os.getpid() % 100
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
        if not arguments.attach:
            start_nodes(processes, folder, arguments.hidden, arguments.seed)
        rig = Rig(processes.check, domain)
        try:
            commands = Commands(processes, console)
            Session(rig, commands, folder, console).run(arguments.runs)
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


if __name__ == "__main__":
    sys.exit(main())
