"""The node's parameters, changed while the port is closed."""

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

from hasel_common.managed_node import node_alone
from hasel_driver.node_parameters import declare
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


def test_parameters_that_together_ground_too_late_are_refused(node):
    """Each is within its range; the one that brings the sum above half a second is not taken."""
    first, second = node.set_parameters(
        [Parameter("heartbeat_timeout", value=0.42), Parameter("dead_time", value=0.05)]
    )
    assert first.successful
    assert "s in all, less than 0.5 s was expected: lower heartbeat_timeout first" in second.reason
    together = [Parameter("heartbeat_timeout", value=0.3), Parameter("dead_time", value=0.05)]
    assert node.set_parameters_atomically(together).successful
