"""The rig's nodes as processes, as `virtual.launch.py` starts them."""

import os
from collections.abc import Mapping
from pathlib import Path

from hasel_bringup.demo.processes import Processes

_NICENESS = 5  # of all but supply and driver, which stop themselves when they are held up
TRACKER = {"source": "topic:camera/image/compressed", "head": "left", "queue_size": 1000, "preview_rate": 0.0}
"""Parameters of a tracker that looks at the virtual camera's pictures."""


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
            "recorded_topics": "['']",  # the recorder's work
        },
    )
    for package, executable, parameters in (
        ("hasel_bringup", "virtual_camera", {"hidden": hidden, "seed": seed}),
        ("hasel_tracker", "tracker_node", TRACKER),
        ("hasel_sim", "simulator", {"own_files": folder}),
        ("hasel_sysid", "sysid", {"output": folder}),
        ("hasel_bringup", "recorder", {"folder": folder / "recordings"}),
    ):
        _start(processes, package, executable, parameters)
        os.setpriority(os.PRIO_PROCESS, processes.process_id(executable), _NICENESS)


def _start(processes: Processes, package: str, executable: str, parameters: Mapping[str, object]) -> None:
    given = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
    processes.start(package, executable, *(["--ros-args", *given] if given else []))
