# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One supply, one driver: another that answers to the same names is noticed, named, and never speaks for both."""

import socket
import time

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")
pytest.importorskip("hasel_interfaces", reason="the workspace is not built")

from hasel_driver.protocol.status import Mode
from hasel_driver.testing.hooks import PUNCTUALITY
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Rig


@pytest.fixture
def other_rig():
    """A second supply."""
    rig = Rig(VIRTUAL_SUPPLY, PUNCTUALITY.note)
    yield rig
    rig.close()


def test_a_second_driver_ends_the_first_ones_arming(start_driver, virtual_rig, other_rig, ros):
    """Grounded, with the other's name and host; neither arms; a stop says how many answer, and is no success."""
    first = start_driver(virtual_rig.port)
    first.arm()
    with ros.commanding():
        ros.wait(lambda: virtual_rig.live)
        second = start_driver(other_rig.port)
        ros.wait(lambda: any("another driver answers" in line for line in list(first.log)), 20.0)
        virtual_rig.await_live(False)
    told = next(line for line in first.log if "another driver answers" in line)
    assert f"/hasel/hasel_driver on {socket.gethostname()} (process {second.process.pid})" in told
    ros.wait(lambda: "commanded by" in "".join(second.log), 10.0)
    for name in ("arm", "emergency_stop", "emergency_stop", "disarm"):
        answer = ros.trigger(name)
        assert not answer.success, answer.message
        if name == "emergency_stop":
            assert "2 drivers answer to this name" in answer.message
    assert not other_rig.live
    second.close()
    ros.wait(lambda: ros.trigger("emergency_stop").success)


def test_a_driver_that_was_killed_does_not_keep_its_successor_from_arming(start_driver, virtual_rig, ros):
    """The middleware knows a killed one for 20 s: its process is gone, so it is no other driver."""
    killed = start_driver(virtual_rig.port)
    ros.await_mode(Mode.STANDBY)
    killed.process.kill()
    killed.process.wait()
    start_driver(virtual_rig.port).arm()
    time.sleep(0.5)
    assert ros.state.mode == Mode.ARMED
