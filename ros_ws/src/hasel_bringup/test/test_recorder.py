# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The recorder's files."""

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")
pytest.importorskip("hasel_interfaces", reason="the workspace is not built")

import rclpy
from hasel_bringup.recorder import RecorderNode
from hasel_recording.bag import read_file
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger


@pytest.fixture
def node(tmp_path):
    """A recorder that is active."""
    rclpy.init(args=["--ros-args", "-p", f"folder:={tmp_path}/runs"])
    node = RecorderNode()
    node.begin()
    yield node
    node.destroy_node()
    rclpy.try_shutdown()


def call(node: RecorderNode, service: str) -> Trigger.Response:
    """The answer of one of its services."""
    client = node.create_client(Trigger, service)
    future = client.call_async(Trigger.Request())
    rclpy.spin_until_future_complete(node, future, timeout_sec=20.0)
    return future.result()


def test_a_recording_has_its_name_and_is_not_overwritten(node, tmp_path):
    """A file of the folder, from start to stop."""
    assert node.set_parameters([Parameter("name", value="monday")])[0].successful
    assert call(node, "recorder/start").success
    assert call(node, "recorder/stop").message == str(tmp_path / "runs" / "monday.mcap")
    assert read_file(tmp_path / "runs" / "monday.mcap").metadata
    assert "no recording is overwritten" in call(node, "recorder/start").message


@pytest.mark.parametrize("name", ["../monday", "/etc/monday", "..", "", "a/b", "a\0b", "~"])
def test_nothing_is_written_outside_the_folder(node, tmp_path, name):
    """Whoever is on the network sets the name, and nobody the folder."""
    node.set_parameters([Parameter("name", value=name)])
    answer = call(node, "recorder/start")
    assert not answer.success, answer
    assert "a name without folders is expected" in answer.message
    assert not node.set_parameters([Parameter("folder", value="/etc")])[0].successful
    assert not list(tmp_path.rglob("*.mcap*"))
