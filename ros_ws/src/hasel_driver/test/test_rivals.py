"""Other drivers of the same name, seen by one that hears nothing yet, not even itself."""

import time
from contextlib import ExitStack

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")
pytest.importorskip("hasel_interfaces", reason="the workspace is not built")

from hasel_common.managed_node import node_alone
from hasel_driver.rivals import Rivals
from hasel_interfaces.msg import SupplyState
from std_srvs.srv import Trigger

STOP = "/hasel/emergency_stop"


@pytest.fixture
def join():
    """Adds nodes, each with a context of its own, that are not spun: they are seen, and hear nothing."""
    with ExitStack() as leaving:

        def add(name: str):
            node = node_alone(name, namespace="/hasel")
            leaving.callback(node.context.shutdown)
            leaving.callback(node.destroy_node)
            return node

        yield add


def _within(condition, duration_s: float) -> bool:
    end_s = time.monotonic() + duration_s
    while not condition() and time.monotonic() < end_s:
        time.sleep(0.01)
    return condition()


@pytest.mark.parametrize("comes", ["a driver", "a service"])
def test_a_driver_that_has_not_found_itself_counts_the_others(join, comes):
    """One of those that are seen is itself; a stop that another answers to as well is not answered for all."""
    own, other = join("hasel_driver"), join("stranger")
    own.create_publisher(SupplyState, "/hasel/state", 10)
    own.create_service(Trigger, STOP, lambda _, response: response)
    rivals = Rivals(own, lambda: [STOP])
    assert not _within(rivals.found, 0.5)
    if comes == "a driver":
        other.create_publisher(SupplyState, "/hasel/state", 10)
    else:
        other.create_service(Trigger, STOP, lambda _, response: response)
    assert _within(lambda: "/hasel/stranger" in "".join(rivals.found()), 5.0)
    assert not rivals.known
    rivals.destroy()
