# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Nodes whose launch is killed leave nothing behind."""

import os
import subprocess
import sys
import time
from pathlib import Path

from ament_index_python.packages import get_package_prefix

NODES = {
    "hasel_simulator": ("hasel_sim", "simulator"),
    "hasel_sysid": ("hasel_sysid", "sysid"),
    "hasel_recorder": ("hasel_bringup", "recorder"),
    "hasel_tracker": ("hasel_tracker", "tracker_node", "--ros-args", "-p", "autostart:=false"),
}
LAUNCH = """
import signal, subprocess, sys, time
signal.signal(signal.SIGHUP, signal.SIG_DFL)  # with `nohup`, as the tests may have been started, nodes are to stay
children = [subprocess.Popen(words.split("|")) for words in sys.argv[1:]]
print(*[child.pid for child in children], flush=True)
time.sleep(1000)
"""


def is_alive(process_id: int) -> bool:
    """Whether it runs; one that has ended and that nobody waits for does not."""
    status = Path(f"/proc/{process_id}/stat")
    try:
        return status.read_text().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def test_no_node_outlives_a_launch_that_is_killed(environment, listener, tmp_path):
    """All that are up end by themselves, as after SIGTERM."""
    commands = [
        "|".join([str(Path(get_package_prefix(package)) / "lib" / package / executable), *options])
        for package, executable, *options in NODES.values()
    ]
    launch = subprocess.Popen(
        [sys.executable, "-c", LAUNCH, *commands],
        stdout=subprocess.PIPE,
        text=True,
        cwd=tmp_path,
        env={**os.environ, **environment},
    )
    try:
        children = [int(word) for word in launch.stdout.readline().split()]
        listener.until(lambda: set(NODES) <= set(listener.node.get_node_names()), 60.0, lambda: None)
    finally:
        launch.kill()
        launch.wait()
    deadline_s = time.monotonic() + 20.0
    while any(map(is_alive, children)) and time.monotonic() < deadline_s:
        time.sleep(0.05)
    assert [name for name, child in zip(NODES, children, strict=True) if is_alive(child)] == []
