# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a user sees on the topics, and the services they call."""

import time
from collections.abc import Callable

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from hasel_common.endpoints import Role
from hasel_common.managed_node import node_alone
from hasel_interfaces.msg import BendingAngle, RunningError, SupplyState
from rclpy.executors import SingleThreadedExecutor
from std_srvs.srv import Trigger

EVERY_MESSAGE = Role.EVERY_SAMPLE.value


def stamp_ns(message) -> int:
    """A message's stamp [ns]."""
    return message.header.stamp.sec * 1_000_000_000 + message.header.stamp.nanosec


class Listener:
    """A node of a ROS domain, with everything it hears."""

    def __init__(self, domain: int) -> None:
        self.node = node_alone("listener", domain=domain)
        self._executor = SingleThreadedExecutor(context=self.node.context)
        self._executor.add_node(self.node)
        self.states: list[SupplyState] = []
        self.measured: list[BendingAngle] = []
        self.simulated: list[BendingAngle] = []
        self.errors: list[RunningError] = []
        self.diagnostics: dict[str, dict[str, str]] = {}
        self._hear(SupplyState, "/hasel/state", self.states.append)
        self._hear(BendingAngle, "/hasel/bending/measured", self.measured.append)
        self._hear(BendingAngle, "/hasel/bending/simulated", self.simulated.append)
        self._hear(RunningError, "/hasel/error", self.errors.append)
        self._hear(DiagnosticArray, "/diagnostics", self._note)

    def _hear(self, kind: type, topic: str, handler: Callable) -> None:
        self.node.create_subscription(kind, topic, handler, EVERY_MESSAGE)

    def _note(self, message: DiagnosticArray) -> None:
        for status in message.status:
            self.diagnostics[status.name] = {pair.key: pair.value for pair in status.values}

    def forget(self) -> None:
        """Begin to listen anew."""
        for heard in (self.states, self.measured, self.simulated, self.errors):
            heard.clear()

    def until(self, condition: Callable[[], object], seconds: float, check: Callable[[], None]) -> None:
        """Spin until something is true; `check` is called meanwhile and may raise."""
        end = time.monotonic() + seconds
        while not condition():
            if time.monotonic() > end:
                raise AssertionError(f"waited {seconds:g} s in vain; heard {self.summary()}")
            check()
            self._executor.spin_once(timeout_sec=0.05)

    def summary(self) -> str:
        """How much was heard."""
        heard = ("states", "measured", "simulated", "errors")
        return ", ".join(f"{len(getattr(self, name))} {name}" for name in heard)

    def call(self, kind: type, name: str, seconds: float, check: Callable[[], None], **request):
        """The answer of a service."""
        client = self.node.create_client(kind, name)
        self.until(client.service_is_ready, 20.0, check)
        future = client.call_async(kind.Request(**request))
        self.until(future.done, seconds, check)
        return future.result()

    def arm(self, rig: str, states: list[SupplyState], check: Callable[[], None]) -> None:
        """Arm a rig, which tells `states`; a virtual board that a busy machine held up has stopped itself before."""
        end = time.monotonic() + 30.0
        while not (answer := self.call(Trigger, f"{rig}/arm", 20.0, check)).success:
            assert time.monotonic() < end, answer.message
            if states and states[-1].mode == SupplyState.FAULT:
                self.call(Trigger, f"{rig}/clear_fault", 20.0, check)
            heard = len(states)
            self.until(lambda heard=heard: len(states) > heard, 5.0, check)

    def close(self) -> None:
        """Leave the domain."""
        self._executor.shutdown()
        self.node.destroy_node()
        rclpy.try_shutdown(context=self.node.context)
