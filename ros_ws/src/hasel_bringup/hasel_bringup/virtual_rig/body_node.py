"""The swimmer and its camera, simulated: hears the supply's state and publishes a measured angle."""

import time

import numpy as np
from hasel_common.declared_parameters import declare, words
from hasel_common.endpoints import Role, frame_of, publisher, subscription
from hasel_common.topics import MEASURED, NAMESPACE, STATE
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_sim.live.live_simulator import live_model
from hasel_sim.live.simulator_interface import angle_message, rig_voltage, to_nanoseconds
from hasel_sim.node_process import RepeatedWarnings
from rclpy.node import Node

from hasel_bringup.hidden_truth.hidden import hidden_values, with_hidden
from hasel_bringup.virtual_rig.body_parameters import PARAMETERS
from hasel_bringup.virtual_rig.camera_noise import CameraNoise
from hasel_bringup.virtual_rig.seen_body import SeenBody


class VirtualBodyNode(Node):
    """Publishes what a camera would see; nobody is told the hidden effects."""

    def __init__(self) -> None:
        super().__init__("hasel_virtual_body", namespace=NAMESPACE)
        self._frame_id = frame_of(self, "camera")
        declare(self, PARAMETERS)
        self._warnings = RepeatedWarnings()
        model, warning = live_model(self._value("model"))
        self._warn(warning)
        hidden = hidden_values(words(self, "hidden"), np.random.default_rng(self._value("seed")))
        self._body = SeenBody(with_hidden(model, hidden), self._value("frame_rate"))
        noise = (self._value(name) for name in ("white_noise", "coloured_noise", "correlation", "seed"))
        self._noise, self._offset = CameraNoise(*noise), self._value("offset")
        self._angles = publisher(self, BendingAngle, MEASURED, Role.SAMPLES)
        subscription(self, SupplyState, STATE, self._on_state, Role.EVERY_SAMPLE)

    def _value(self, name: str):
        return self.get_parameter(name).value

    def _warn(self, sentence: str) -> None:
        sentence = sentence and self._warnings.to_say(sentence, time.monotonic())
        if sentence:
            self.get_logger().warning(sentence)

    def _on_state(self, state: SupplyState) -> None:
        angles, sentence = self._body.state(to_nanoseconds(state.header.stamp), rig_voltage(state))
        self._warn(sentence)
        for angle in angles:
            seen = angle.sin_theta + self._offset + self._noise.next()
            message = angle_message(angle.stamp_ns, float(np.clip(seen, -1.0, 1.0)), self._frame_id)
            self._angles.publish(message)
