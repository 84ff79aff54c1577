# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Each launch file starts its nodes, in the namespace that is asked for, and ends them cleanly."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from ament_index_python.packages import get_package_share_directory
from hasel_common.endpoints import Role
from hasel_interfaces.msg import BendingAngle

pytest.importorskip("launch_ros", reason="launch and launch_ros come with ROS 2 from apt, not as wheels")

_PROGRAM = """
import sys
from launch import LaunchDescription, LaunchService
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
file, *arguments = sys.argv[1:]
service = LaunchService(noninteractive=True)
source = PythonLaunchDescriptionSource(file)
given = [tuple(argument.split(":=", 1)) for argument in arguments]
service.include_launch_description(
    LaunchDescription([IncludeLaunchDescription(source, launch_arguments=given)])
)
sys.exit(service.run())
"""


@pytest.mark.timeout(400)
@pytest.mark.parametrize(
    ("file", "arguments"),
    [
        ("rig.launch.py", ["virtual:=true"]),
        ("virtual.launch.py", ["experiment:=false", "hidden:=none", "output:={folder}"]),
        ("replay.launch.py", ["recording:={folder}/run.csv"]),
    ],
)
def test_nodes_are_started_and_ended(tmp_path, environment, listener, file, arguments):
    """The simulator answers in the namespace; at Ctrl-C no node dies with another code than 0."""
    rows = [f"{index / 100},{3000 * (index // 50 % 2)},0,0.0" for index in range(2000)]
    (tmp_path / "run.csv").write_text(
        "\n".join(["time_s,voltage_upper_v,voltage_lower_v,sin_theta", *rows]) + "\n"
    )
    simulated: list[BendingAngle] = []
    listener.node.create_subscription(
        BendingAngle, "/rig2/bending/simulated", simulated.append, Role.EVERY_SAMPLE.value
    )
    path = Path(get_package_share_directory("hasel_bringup")) / "launch" / file
    given = ["namespace:=rig2", *(argument.format(folder=tmp_path) for argument in arguments)]
    with (tmp_path / "launch.log").open("w") as output:
        process = subprocess.Popen(
            [sys.executable, "-c", _PROGRAM, str(path), *given],
            stdout=output,
            stderr=subprocess.STDOUT,
            env={**os.environ, **environment, "ROS_LOG_DIR": str(tmp_path / "log")},
            cwd=tmp_path,
        )
        try:
            listener.until(lambda: len(simulated) > 20, 200.0, lambda: _check(process, tmp_path))
        finally:
            process.send_signal(signal.SIGINT)
            code = process.wait(60.0)
    printed = (tmp_path / "launch.log").read_text()
    assert code == 0, printed
    assert "process has died" not in printed, printed
    assert "Traceback" not in printed, printed


def _check(process: subprocess.Popen, folder: Path) -> None:
    if process.poll() is not None:
        raise AssertionError((folder / "launch.log").read_text())
