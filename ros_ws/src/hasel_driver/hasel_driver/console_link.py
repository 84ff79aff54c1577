"""What the console says to the driver's node and hears of it."""

import os
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import rclpy
from hasel_common.endpoints import Role, frame_of, publisher, subscription
from hasel_common.managed_node import BackgroundSpin
from hasel_common.topics import COMMAND, NAMESPACE, STATE
from hasel_interfaces.msg import Actuation, SupplyState
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters
from rclpy.publisher import Publisher
from std_srvs.srv import Trigger

from hasel_driver.errors import RefusedError
from hasel_driver.limits import Voltages

ANSWER_S = 5.0
FRESH_S = 0.5
CLAIM_PERIOD_S = 0.02
TO_GROUND = {"emergency_stop", "disarm"}  # which are sent however many answer


class ConsoleLink:
    """A node of its own, spun in the background; `command` publishes only within `commanding`."""

    def __init__(self, namespace: str = NAMESPACE) -> None:
        rclpy.init()
        self._node = rclpy.create_node(f"hasel_console_{os.getpid()}", namespace=namespace)
        self._state: SupplyState | None = None
        self._heard_s = 0.0
        self._commands: Publisher | None = None
        subscription(self._node, SupplyState, STATE, self._take, Role.SAMPLES)
        self._clients: dict[str, Any] = {}
        self._spin = BackgroundSpin(self._node, "console", owns_context=True)

    def state(self) -> SupplyState | None:
        """The last state, if it is of now."""
        return self._state if time.monotonic() - self._heard_s < FRESH_S else None

    def await_mode(self, mode: int) -> SupplyState | None:
        """The last state; one that is about to have this mode is waited for."""
        end_s = time.monotonic() + FRESH_S
        while time.monotonic() < end_s and (self._state is None or self._state.mode != mode):
            time.sleep(0.01)
        return self.state()

    def trigger(self, name: str) -> str:
        """Call one of the driver's services; its words. Raises RefusedError with them where it fails."""
        answer = self._ask(Trigger, name, Trigger.Request())
        if not answer.success:
            raise RefusedError(answer.message)
        return answer.message

    def lower_limit(self, voltage_v: float) -> str:
        """Lower the driver's maximum voltage [V]."""
        value = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=voltage_v)
        request = SetParameters.Request(parameters=[Parameter(name="maximum_voltage", value=value)])
        (result,) = self._ask(SetParameters, "hasel_driver/set_parameters", request).results
        if not result.successful:
            raise RefusedError(result.reason)
        return f"The limit is {voltage_v:g} V."

    @contextmanager
    def commanding(self) -> Iterator[None]:
        """The driver obeys one publisher of commands: this one is there only as long as it is needed.

        Raises RefusedError where that is another.
        """
        self._commands = publisher(self._node, Actuation, COMMAND, Role.COMMANDS)
        try:
            end_s = time.monotonic() + ANSWER_S
            while (holder := self._holder()) != self._node.get_fully_qualified_name():
                if time.monotonic() > end_s:
                    raise RefusedError(
                        f"The driver obeys {holder or 'nobody'}: end that node, or disarm and arm again."
                    )
                self.command((0.0, 0.0))  # with which every controller begins
                time.sleep(CLAIM_PERIOD_S)
            yield
        finally:
            self._node.destroy_publisher(self._commands)
            self._commands = None

    def command(self, voltage_v: Voltages) -> None:
        """Publish one command."""
        message = Actuation(voltage=list(voltage_v))
        message.header.frame_id = frame_of(self._node, "supply")
        message.header.stamp = self._node.get_clock().now().to_msg()
        self._commands.publish(message)

    def close(self) -> None:
        """Leave."""
        self._spin.close()

    def _holder(self) -> str:
        state = self.state()
        return state.commander if state else ""

    def _take(self, state: SupplyState) -> None:
        self._state, self._heard_s = state, time.monotonic()

    def _ask(self, kind: type, name: str, request: Any) -> Any:
        if name not in self._clients:
            self._clients[name] = self._node.create_client(kind, name)
        client = self._clients[name]
        if client.wait_for_service(ANSWER_S):
            answering = self._node.count_services(client.srv_name)
            refusal = (
                f"{answering} nodes answer {client.srv_name}, and one answer would stand for all: stop each supply"
                " by its switch, and end all but one."
            )
            if answering > 1 and name not in TO_GROUND:
                raise RefusedError(refusal)
            done = threading.Event()
            future = client.call_async(request)
            future.add_done_callback(lambda _: done.set())
            answered = done.wait(ANSWER_S)
            if answering > 1:
                raise RefusedError(f"It was sent, but {refusal}")
            if answered:
                return future.result()
        raise RefusedError(
            f"{client.srv_name} gives no answer: start the driver's node, or treat the output as live."
        )
