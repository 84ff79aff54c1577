# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Other nodes that a driver meets: found within half a second, named, not obeyed, and nothing untrue is said."""

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")
pytest.importorskip("hasel_interfaces", reason="the workspace is not built")

from hasel_driver.testing.neighbours import NEIGHBOURS, meet


@pytest.mark.parametrize("kind", NEIGHBOURS, ids=lambda kind: kind.name)
def test_a_neighbour_is_found_or_not_obeyed(rig, ros, kind):
    """Truth is what the simulated muscles have, never a node's word."""
    assert meet(ros, kind, rig).wrong == []
