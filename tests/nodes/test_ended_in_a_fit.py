# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A node that is asked to end while it fits does not keep anybody waiting."""

import os
import signal
from pathlib import Path

import pytest
from hasel_bringup.processes import Processes
from hasel_interfaces.srv import FitModel

RUNS = sorted(
    (Path(__file__).resolve().parents[2] / "data" / "unseen_rig" / "quadratic_drag").glob("fit_*.csv")
)


def descendants(number: int) -> set[int]:
    """Process ids of everything that a process started, and what that started."""
    parents = {}
    for folder in Path("/proc").iterdir():
        try:
            parents[int(folder.name)] = int((folder / "stat").read_text().rpartition(")")[2].split()[1])
        except (ValueError, OSError):
            continue
    found, new = set(), {number}
    while new:
        new = {child for child, parent in parents.items() if parent in new} - found
        found |= new
    return found


def is_gone(number: int) -> bool:
    """Whether a process has ended (one that nobody waits for stays as a zombie)."""
    try:
        state = Path(f"/proc/{number}/stat").read_text().rpartition(")")[2].split()[0]
    except OSError:
        return True
    return state == "Z"


@pytest.mark.timeout(240)
@pytest.mark.parametrize(("number", "jobs"), [(signal.SIGINT, 2), (signal.SIGTERM, 1)])
def test_a_fit_is_given_up(tmp_path, environment, listener, number, jobs):
    """Within seconds, with its worker processes, exit code 0 and no stack trace."""
    with Processes(tmp_path, environment) as processes:
        processes.start(
            "hasel_sysid", "sysid", "--ros-args", "-p", f"jobs:={jobs}", "-p", f"output:={tmp_path}"
        )
        client = listener.node.create_client(FitModel, "/hasel/fit")
        listener.until(client.service_is_ready, 60.0, processes.check)
        client.call_async(FitModel.Request(recordings=[str(path) for path in RUNS]))
        said = processes.output("sysid")
        listener.until(lambda: "low-fidelity" in said.read_text(), 120.0, processes.check)
        sysid = processes.process_id("sysid")
        workers = descendants(sysid)
        assert len(workers) >= (0 if jobs == 1 else jobs)
        os.kill(sysid, number)
        assert processes.finish("sysid", 20.0) == 0
        listener.until(lambda: all(is_gone(worker) for worker in workers), 20.0, lambda: None)
        assert "given up" in said.read_text()
        assert "Traceback" not in said.read_text()
    assert not list(tmp_path.glob("*.yaml"))
