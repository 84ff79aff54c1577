# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The simulator as a node on real DDS, in this process."""

import time

import numpy as np
import pytest
import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from hasel_common.endpoints import Role
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_interfaces.srv import AddEffect, LoadModel, RemoveEffect
from hasel_sim.live.live_simulator import LiveSimulator
from hasel_sim.live.simulator_interface import to_nanoseconds, to_time
from hasel_sim.live.simulator_node import SimulatorNode
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.srv import SetParameters
from rclpy.executors import SingleThreadedExecutor
from rclpy.parameter import Parameter
from visualization_msgs.msg import MarkerArray

_FRAME = 8_333_333


class Rig:
    """The node, and a second one that talks to it."""

    def __init__(self) -> None:
        self.node, self.user = SimulatorNode(), rclpy.create_node("user")
        self.node.begin()
        self.executor = SingleThreadedExecutor()
        self.executor.add_node(self.node)
        self.executor.add_node(self.user)
        self.angles: list[BendingAngle] = []
        self.shapes: list[MarkerArray] = []
        self.diagnostics: list[DiagnosticArray] = []
        self._hear(BendingAngle, "/hasel/bending/simulated", self.angles, Role.EVERY_SAMPLE.value)
        self._hear(MarkerArray, "/hasel/swimmer", self.shapes, 10)
        self._hear(DiagnosticArray, "/diagnostics", self.diagnostics, 10)
        self.states = self.user.create_publisher(SupplyState, "/hasel/state", Role.EVERY_SAMPLE.value)
        self.until(lambda: self.states.get_subscription_count() and self.heard() == 3)

    def heard(self) -> int:
        """How many of the node's topics have reached the user's subscriptions."""
        topics = ("/hasel/bending/simulated", "/hasel/swimmer", "/diagnostics")
        return sum(self.user.count_publishers(topic) > 0 for topic in topics)

    def _hear(self, kind, topic, heard, quality) -> None:
        self.user.create_subscription(kind, topic, heard.append, quality)

    def until(self, condition, seconds: float = 20.0) -> None:
        """Spin until something is true."""
        end = time.monotonic() + seconds
        while not condition():
            assert time.monotonic() < end, "waited too long"
            self.executor.spin_once(timeout_sec=0.05)

    def say(self, stamp_ns: int, voltage: list[float]) -> None:
        """Publish a state."""
        state = SupplyState(commanded_voltage=voltage)
        state.header.stamp = to_time(stamp_ns)
        self.states.publish(state)

    def call(self, kind, name: str, **request):
        """The answer of a service."""
        future = self.user.create_client(kind, name).call_async(kind.Request(**request))
        self.until(future.done)
        return future.result()

    def set(self, name: str, value: float):
        """Set a parameter of the node and return the result."""
        parameter = Parameter(name, value=value).to_parameter_msg()
        return self.call(
            SetParameters, "/hasel/hasel_simulator/set_parameters", parameters=[parameter]
        ).results[0]

    def change(self, transition: int) -> bool:
        """Ask for a transition of the lifecycle; whether it succeeded."""
        request = {"transition": Transition(id=transition)}
        return self.call(ChangeState, "/hasel/hasel_simulator/change_state", **request).success

    def close(self) -> None:
        """Destroy both nodes."""
        self.executor.shutdown()
        self.node.destroy_node()
        self.user.destroy_node()


@pytest.fixture
def rig():
    """A running node."""
    rclpy.init()
    rig = Rig()
    yield rig
    rig.close()
    rclpy.try_shutdown()


def test_angles_come_at_the_stamps_of_the_states(rig):
    """One for each state, with the numbers of the core, and the picture beside it."""
    core = LiveSimulator(rig.node.live.model)
    stamps = [1_800_000_000_000_000_000 + _FRAME * n for n in range(40)]
    expected = [core.receive(s, np.array([5000.0, 0.0])).angles[0].sin_theta for s in stamps]
    for stamp in stamps:
        rig.say(stamp, [5000.0, 0.0])
    rig.until(lambda: len(rig.angles) == len(stamps) and rig.shapes)
    assert [to_nanoseconds(angle.header.stamp) for angle in rig.angles] == stamps
    assert [angle.sin_theta for angle in rig.angles] == expected
    assert len(rig.angles[0].marker_x) == 0
    assert {marker.ns for marker in rig.shapes[0].markers} >= {
        "upper_muscle",
        "lower_muscle",
        "skin",
        "markers",
    }


def test_an_inactive_node_hears_no_state_and_starts_from_rest_afterwards(rig):
    """It costs nothing meanwhile, and the model can be changed."""
    rig.say(0, [5000.0, 0.0])
    rig.until(lambda: len(rig.angles) == 1)
    assert rig.change(Transition.TRANSITION_DEACTIVATE)
    rig.until(lambda: rig.states.get_subscription_count() == 0)
    assert rig.call(AddEffect, "/hasel/add_effect", effect="quadratic_drag").success
    assert rig.change(Transition.TRANSITION_ACTIVATE)
    rig.until(lambda: rig.states.get_subscription_count() == 1)
    for n in (1000, 1001):
        rig.say(_FRAME * n, [5000.0, 0.0])
    rig.until(lambda: len(rig.angles) == 3)
    assert [to_nanoseconds(angle.header.stamp) for angle in rig.angles[1:]] == [_FRAME * 1000, _FRAME * 1001]
    assert rig.angles[1].sin_theta == rig.angles[0].sin_theta


def test_an_unconfigured_node_says_what_to_do(rig):
    """Its model's parameters are gone, and come back when it is configured again."""
    assert rig.change(Transition.TRANSITION_DEACTIVATE)
    assert rig.change(Transition.TRANSITION_CLEANUP)
    assert not any(name.startswith("parameters.") for name in rig.node._parameters)
    answer = rig.call(AddEffect, "/hasel/add_effect", effect="quadratic_drag")
    assert (answer.success, "configure the node" in answer.message) == (False, True)
    assert rig.change(Transition.TRANSITION_CONFIGURE)
    assert any(name.startswith("parameters.") for name in rig.node._parameters)


def test_a_late_message_is_held_and_said(rig):
    """It leads to no angle and to a warning in the diagnostics; the node lives on."""
    for n in (0, 1, 2, 1, 3):
        rig.say(_FRAME * n, [0.0, 0.0])
    rig.until(lambda: len(rig.angles) == 4)

    def warned() -> bool:
        entries = [status for array in rig.diagnostics for status in array.status]
        values = [
            {pair.key: pair.value for pair in entry.values} for entry in entries if entry.level == b"\x01"
        ]
        return any(value["held: late or repeated messages"] == "1" for value in values)

    rig.until(warned)


def test_effects_come_and_go_while_running(rig):
    """An added effect has no influence until its parameter is set, and none after it is removed."""
    answer = rig.call(AddEffect, "/hasel/add_effect", effect="quadratic_drag")
    assert answer.success
    assert "parameters.quadratic_drag.coefficient (typically 0.3)." in answer.message
    assert rig.node.live.model.values["quadratic_drag.coefficient"] == 0.0
    assert rig.set("parameters.quadratic_drag.coefficient", 0.25).successful
    assert rig.node.live.model.values["quadratic_drag.coefficient"] == 0.25
    assert not rig.set("parameters.quadratic_drag.coefficient", 1e9).successful
    assert rig.call(RemoveEffect, "/hasel/remove_effect", effect="quadratic_drag").success
    assert rig.node.live.model.effects == ()
    assert not rig.node.has_parameter("parameters.quadratic_drag.coefficient")


def test_a_mistaken_request_is_answered_by_a_sentence(rig):
    """An unknown effect or model is refused with the nearest known one; the model stays."""
    before = rig.node.live.model
    answer = rig.call(AddEffect, "/hasel/add_effect", effect="quadratic_dragg")
    assert (answer.success, "quadratic_drag" in answer.message) == (False, True)
    answer = rig.call(LoadModel, "/hasel/load_model", model="swimer")
    assert (answer.success, "swimmer" in answer.message) == (False, True)
    assert not rig.call(RemoveEffect, "/hasel/remove_effect", effect="quadratic_drag").success
    assert rig.node.live.model is before


def test_no_file_is_read_that_a_request_names(rig, tmp_path):
    """Whoever reaches the node must not have it run code, unless it lies in the folder given at the start."""
    own = tmp_path / "evil.py"
    own.write_text("raise SystemExit('it was run')")
    for answer in (
        rig.call(AddEffect, "/hasel/add_effect", effect=f"{own}:Evil"),
        rig.call(LoadModel, "/hasel/load_model", model=str(tmp_path / "evil.yaml")),
    ):
        assert (answer.success, "own_files" in answer.message) == (False, True)


def test_another_body_can_be_loaded(rig):
    """After the beam is loaded it is the beam that is drawn, from rest."""
    rig.say(0, [0.0, 0.0])
    rig.until(lambda: rig.shapes)
    assert rig.call(LoadModel, "/hasel/load_model", model="beam").success
    rig.shapes.clear()
    time.sleep(0.1)  # shapes come at most 20 times a second
    rig.say(10_000_000, [0.0, 0.0])
    rig.until(lambda: rig.shapes)
    assert not {marker.ns for marker in rig.shapes[0].markers} & {"upper_muscle", "lower_muscle"}
