# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The order in which nodes go up and down, and what becomes of the driver when another node ends."""

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

from hasel_bringup.lifecycle_manager import BringUp, Change, Lifecycle

NAMES = ("driver", "tracker", "sysid")
AFTER = {
    Change.CONFIGURE: Lifecycle.INACTIVE,
    Change.ACTIVATE: Lifecycle.ACTIVE,
    Change.DEACTIVATE: Lifecycle.INACTIVE,
    Change.CLEANUP: Lifecycle.UNCONFIGURED,
}


class Nodes:
    """Nodes that do what they are asked for."""

    def __init__(self) -> None:
        self.states = dict.fromkeys(NAMES, Lifecycle.UNCONFIGURED)
        self.bring_up = BringUp(NAMES)

    def settle(self) -> list[str]:
        """Do all that is asked for; what that was."""
        asked = []
        while (wanted := self.bring_up.next_change(self.states)) is not None:
            name, change = wanted
            asked.append(f"{change.value} {name}")
            self.states[name] = AFTER[change]
            assert len(asked) < 20
        return asked


@pytest.fixture
def nodes() -> Nodes:
    """All there and unconfigured."""
    return Nodes()


def test_all_are_configured_and_then_activated_in_order(nodes):
    """The driver first."""
    expected = [f"{what} {name}" for what in ("configure", "activate") for name in NAMES]
    assert nodes.settle() == expected
    assert set(nodes.states.values()) == {Lifecycle.ACTIVE}


def test_nobody_goes_up_before_all_are_there(nodes):
    """A driver that is active without a tracker could be armed unseen."""
    nodes.states["sysid"] = Lifecycle.ABSENT
    assert nodes.settle() == []
    assert nodes.bring_up.absent(nodes.states) == ["sysid"]


def test_all_go_down_the_driver_first(nodes):
    """It is deactivated, which grounds, before anything else is touched; up again at startup."""
    nodes.settle()
    nodes.bring_up.shutdown()
    assert nodes.settle() == [f"{what} {name}" for what in ("deactivate", "clean up") for name in NAMES]
    nodes.bring_up.startup()
    assert len(nodes.settle()) == 6


@pytest.mark.parametrize("left", [Lifecycle.ABSENT, Lifecycle.UNCONFIGURED])
def test_the_driver_goes_down_when_another_node_ends(nodes, left):
    """Also where that is back before anybody noticed; all go up again when all are there."""
    nodes.settle()
    nodes.states["tracker"] = left
    assert nodes.bring_up.ended(nodes.states) == ["tracker"]
    asked = nodes.settle()
    assert asked[0] == "deactivate driver"
    if left is Lifecycle.ABSENT:
        assert asked[1:] == []
        nodes.states["tracker"] = Lifecycle.UNCONFIGURED
        asked += nodes.settle()
    assert asked[1:] == ["configure tracker", "activate driver", "activate tracker"]


def test_what_somebody_else_took_down_is_left_to_them(nodes):
    """Until the next startup."""
    nodes.settle()
    nodes.states["driver"] = Lifecycle.INACTIVE
    assert nodes.settle() == []
    nodes.bring_up.startup()
    assert nodes.settle() == ["activate driver"]
