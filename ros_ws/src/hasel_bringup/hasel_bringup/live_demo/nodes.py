"""The rig's nodes as processes, as `virtual.launch.py` starts them."""

import os
from collections.abc import Mapping
from pathlib import Path

from ament_index_python.packages import get_package_share_directory

from hasel_bringup.demo.processes import Processes

_NICENESS = 5  # of all but supply and driver, which stop themselves when they are held up


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
