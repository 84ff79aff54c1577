# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The node's parameters, changed while the port is closed, and files of them that would be ignored."""

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

from hasel_common.managed_node import node_alone
from hasel_driver.nodes.parameters import TABLE, check_files, declare
from hasel_driver.protocol.faults import LimitError
from rclpy.parameter import Parameter


@pytest.fixture
def node():
    """One with the driver's parameters, its port closed."""
    node = node_alone("parameters")
    declare(node, lambda: False, lambda voltage_v: None)
    yield node
    node.destroy_node()
    node.context.try_shutdown()


@pytest.mark.parametrize(
    "name", ["state_folder", "recording_directory", "waveform_directory", "history_file"]
)
def test_where_files_are_is_said_at_the_start_only(node, name):
    """Nobody on the network moves them, the port closed or not."""
    (result,) = node.set_parameters([Parameter(name, value="/etc")])
    assert (result.successful, "given at the start" in result.reason) == (False, True)


def test_what_is_in_use_may_be_set_to_what_it_is():
    """`ros2 param load` of the node's own dump changes nothing while it drives; what differs is refused."""
    node = node_alone("parameters")
    try:
        lowered: list[float] = []
        declare(node, lambda: True, lowered.append)
        same = [Parameter(name, value=node.get_parameter(name).value) for name in TABLE]
        refused = [result.reason for result in node.set_parameters(same) if not result.successful]
        (other,) = node.set_parameters([Parameter("slew_rate", value=100e3)])
        assert (refused, lowered, other.successful) == ([], [], False)
    finally:
        node.destroy_node()
        node.context.try_shutdown()


def test_parameters_that_together_ground_too_late_are_refused(node):
    """Each is within its range; the one that brings the sum above half a second is not taken."""
    first, second = node.set_parameters(
        [Parameter("heartbeat_timeout", value=0.42), Parameter("dead_time", value=0.05)]
    )
    assert first.successful
    assert "s in all, less than 0.5 s was expected: lower heartbeat_timeout first" in second.reason
    together = [Parameter("heartbeat_timeout", value=0.3), Parameter("dead_time", value=0.05)]
    assert node.set_parameters_atomically(together).successful


SECTION = "{}:\n  ros__parameters:\n    maximum_voltage: 2000.0\n"


@pytest.mark.parametrize("name", ["/**/hasel_driver", "/**", "/hasel/hasel_driver", "hasel_tracker"])
def test_takes_what_reaches_the_node(tmp_path, name):
    """Wildcards, the full name, and sections of other nodes."""
    file = tmp_path / "rig.yaml"
    file.write_text(SECTION.format(name))
    check_files("hasel_driver", "/hasel/hasel_driver", ["--ros-args", "--params-file", str(file)])


def test_refuses_what_would_be_ignored(tmp_path):
    """The section is for the node in the root namespace; the sentence says what to write."""
    file = tmp_path / "rig.yaml"
    file.write_text(SECTION.format("hasel_driver"))
    with pytest.raises(LimitError, match=r"this node is /rig2/hasel_driver.*write /\*\*/hasel_driver there"):
        check_files("hasel_driver", "/rig2/hasel_driver", ["--ros-args", "--params-file", str(file)])


def test_takes_what_launch_writes(tmp_path):
    """A list given in a launch file comes as a tuple of Python."""
    file = tmp_path / "launch.yaml"
    file.write_text("/**:\n  ros__parameters:\n    recorded_topics: !!python/tuple\n    - ''\n")
    check_files("hasel_driver", "/hasel/hasel_driver", ["--ros-args", "--params-file", str(file)])
