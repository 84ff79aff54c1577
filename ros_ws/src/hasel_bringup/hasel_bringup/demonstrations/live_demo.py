# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_bringup live_demo`: the whole rig live without hardware, and an effect that it has to find."""

import argparse
import os
import signal
import sys
from collections.abc import Mapping
from pathlib import Path

from ament_index_python.packages import get_package_share_directory
from rich.console import Console

from hasel_bringup.demonstrations.live_session import Session
from hasel_bringup.experimenter import Experimenter
from hasel_bringup.processes import ALONE, OWN_DOMAIN, Processes

_NICENESS = 5  # of all but supply and driver, which stop themselves when they are held up


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    try:
        _run(options)
    except KeyboardInterrupt:
        print(
            "Interrupted: the nodes have ended, what was recorded is complete up to there.", file=sys.stderr
        )
    return 0


def _run(options: argparse.Namespace) -> None:
    folder = _fresh(options.output)
    console = Console(highlight=False)
    domain = None if options.attach else OWN_DOMAIN
    environment = {} if options.attach else ALONE
    os.environ.update(environment)
    if not options.attach:
        console.print(
            f"A ROS domain of its own, so that no real rig hears it: ROS_DOMAIN_ID={domain} "
            "ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST ros2 topic echo /hasel/error",
            soft_wrap=True,
        )
    with Processes(folder / "logs", environment) as processes:
        if not options.attach:
            start_nodes(processes, folder, options.hidden, options.seed)
        rig = Experimenter(processes.check, domain)
        try:
            Session(rig, processes, folder, console).run(options.runs)
        finally:
            rig.close()


def _fresh(output: Path) -> Path:
    """A folder of this name that has nothing in it yet: numbered where there is one."""
    number, folder = 1, output
    while folder.exists() and any(folder.iterdir()):
        number += 1
        folder = output.with_name(f"{output.name}_{number}")
    folder.mkdir(parents=True, exist_ok=True)
    return folder.resolve()


def start_nodes(processes: Processes, folder: Path, hidden: str, seed: int) -> None:
    """Start supply, driver, camera, tracker, simulator, identification and recorder; their output goes to files."""
    port = folder / "supply_port"
    processes.start("hasel_driver", "virtual_supply", "--link", str(port))
    _start(
        processes,
        "hasel_driver",
        "driver_node",
        {
            "port": port,
            "history_file": folder / "supply_history.jsonl",
            "state_folder": folder / "supply_state",
            "recording_directory": folder,
        },
    )
    for package, executable, parameters in (
        ("hasel_bringup", "virtual_camera", {"hidden": f"[{hidden}]", "seed": seed}),
        ("hasel_tracker", "tracker_node", {}),
        ("hasel_sim", "simulator", {"own_files": folder}),
        ("hasel_sysid", "sysid", {"output": folder}),
        ("hasel_bringup", "recorder", {"folder": folder / "recordings"}),
    ):
        _start(processes, package, executable, parameters)
        os.setpriority(os.PRIO_PROCESS, processes.process_id(executable), _NICENESS)


def _start(processes: Processes, package: str, executable: str, parameters: Mapping[str, object]) -> None:
    config = Path(get_package_share_directory("hasel_bringup")) / "config" / "virtual.yaml"
    given = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
    processes.start(package, executable, "--ros-args", "--params-file", str(config), *given)
