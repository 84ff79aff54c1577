# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A user of the driver's topics and services, and the driver's node in a process of its own."""

import subprocess
import sys
import tempfile
import threading
import time
from collections import deque
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from hasel_common.managed_node import BackgroundSpin, node_alone
from hasel_interfaces.msg import Actuation, SupplyState
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.duration import Duration
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Bool
from std_srvs.srv import Trigger

from hasel_driver.nodes.driver_services import OUTPUT_WORDS
from hasel_driver.protocol.limits import Voltages
from hasel_driver.protocol.status import Mode
from hasel_driver.testing.rig import Rig

LATCHED = QoSProfile(
    depth=1, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL
)
ANSWER_TIMEOUT_S = 4.0
COMMAND_PERIOD_S = 0.02


class RosClient:
    """For some tests; `states` collects `/hasel/state` and may be cleared, `heard` keeps the last."""

    def __init__(self, name: str = "user") -> None:
        # Alone: other tests of the same process make contexts of theirs, and the signals are the test runner's.
        self.node = node_alone(name)
        self.states: list[SupplyState] = []
        self.heard: deque[SupplyState] = deque(maxlen=10_000)
        self.node.create_subscription(SupplyState, "/hasel/state", self._take_state, 200)
        self.commands: Publisher | None = self.node.create_publisher(Actuation, "/hasel/command", 100)
        self._stop: Any = None
        self._clients: dict[str, Any] = {}
        self._spin = BackgroundSpin(self.node, name, owns_context=True)

    def _take_state(self, state: SupplyState) -> None:
        self.states.append(state)
        self.heard.append(state)

    def close(self) -> None:
        """Leave the graph."""
        self._spin.close()

    def _client(self, kind: type, name: str) -> Any:
        if name not in self._clients:
            self._clients[name] = self.node.create_client(kind, name)
        return self._clients[name]

    def request(self, kind: type, name: str, request: Any) -> Any:
        """Call a service and wait for its answer."""
        client = self._client(kind, name)
        for _ in range(3):
            if client.wait_for_service(10.0):
                future = client.call_async(request)
                with suppress(AssertionError):  # a node that was killed may be taken for the one that comes
                    self.wait(future.done, ANSWER_TIMEOUT_S)
                    return future.result()
        raise AssertionError(f"{name} gave no answer")

    def trigger(self, name: str) -> Trigger.Response:
        """Call /hasel/<name>."""
        return self.request(Trigger, f"/hasel/{name}", Trigger.Request())

    def transition(self, identifier: int) -> None:
        """Request a lifecycle transition and wait for it."""
        request = ChangeState.Request()
        request.transition.id = identifier
        if not self.request(ChangeState, "/hasel/hasel_driver/change_state", request).success:
            raise AssertionError(f"the transition {identifier} failed")

    def activate(self) -> None:
        """Bring the node's lifecycle to active, from unconfigured or inactive."""
        request = GetState.Request()
        state = self.request(GetState, "/hasel/hasel_driver/get_state", request).current_state.id
        if state == State.PRIMARY_STATE_UNCONFIGURED:
            self.transition(Transition.TRANSITION_CONFIGURE)
        if state != State.PRIMARY_STATE_ACTIVE:
            self.transition(Transition.TRANSITION_ACTIVATE)

    def illegal_transition(self, identifier: int) -> None:
        """Request a transition that will never be answered."""
        client = self._client(ChangeState, "/hasel/hasel_driver/change_state")
        if not client.wait_for_service(5.0):
            raise AssertionError("there is no lifecycle service")
        request = ChangeState.Request()
        request.transition.id = identifier
        client.call_async(request)

    def command(self, voltage_v: Voltages, age_s: float = 0.0) -> None:
        """Publish one command, unless within `silent`."""
        if self.commands is None:
            return
        message = Actuation(voltage=list(voltage_v))
        message.header.stamp = (self.node.get_clock().now() - Duration(seconds=age_s)).to_msg()
        self.commands.publish(message)

    @contextmanager
    def commanding(self, voltage_v: Voltages = (3000.0, -2000.0)) -> Iterator[None]:
        """Command at 50 Hz in the background."""
        ended = threading.Event()

        def publish() -> None:
            self.command((0.0, 0.0))  # with which every controller begins
            while not ended.wait(COMMAND_PERIOD_S):
                self.command(voltage_v)

        thread = threading.Thread(target=publish, daemon=True)
        thread.start()
        try:
            yield
        finally:
            ended.set()
            thread.join()

    @contextmanager
    def silent(self) -> Iterator[None]:
        """Publish no commands, nor be able to: somebody else does."""
        commands, self.commands = self.commands, None
        self.node.destroy_publisher(commands)
        try:
            yield
        finally:
            self.commands = self.node.create_publisher(Actuation, "/hasel/command", 100)

    def drive(
        self, until: Callable[[], bool], voltage_v: Voltages = (3000.0, -2000.0), timeout_s: float = 3.0
    ) -> None:
        """Command at 50 Hz until `until()`."""
        with self.commanding(voltage_v):
            self.wait(until, timeout_s)

    def emergency_stop_topic(self, stop: bool, quality: QoSProfile | int = LATCHED) -> None:
        """Publish on the topic, which is latched unless another quality of service is asked for."""
        if self._stop is None:
            self._stop = self.node.create_publisher(Bool, "/hasel/emergency_stop", quality)
        self._stop.publish(Bool(data=stop))

    def drop_emergency_stop_topic(self) -> None:
        """Take its publisher away."""
        if self._stop is not None:
            self.node.destroy_publisher(self._stop)
            self._stop = None

    @property
    def state(self) -> SupplyState:
        """The last state."""
        return self.states[-1]

    def wait(self, condition: Callable[[], bool], timeout_s: float = 5.0) -> None:
        """Until `condition()` holds."""
        end_s = time.monotonic() + timeout_s
        while not condition():
            if time.monotonic() > end_s:
                raise AssertionError(f"waited {timeout_s} s in vain, the last state is {self.states[-1:]}")
            time.sleep(0.005)

    def false_proofs(self, rig: Rig) -> list[str]:
        """States, of whatever driver, that call the output grounded while it was live in truth."""
        offset_s = time.time() - time.monotonic()
        proofs = [(_stamp_s(state) - offset_s, state) for state in list(self.heard) if state.grounded]
        return [str(state) for time_s, state in proofs if rig.refutes_dead_at(time_s)]

    def false_claims(self, rig: Rig, since_s: float) -> list[str]:
        """States stamped after `since_s` (monotonic) [s] that claim no voltage while the output was live in truth."""
        offset_s = time.time() - time.monotonic()
        claims = [(_stamp_s(state) - offset_s, state) for state in list(self.heard) if _claims_dead(state)]
        return [str(state) for time_s, state in claims if time_s >= since_s and rig.refutes_dead_at(time_s)]

    def await_mode(self, mode: Mode, timeout_s: float = 10.0) -> SupplyState:
        """Until a state published from now on has this mode; returns it."""
        self.states.clear()
        self.wait(lambda: bool(self.states) and self.states[-1].mode == mode, timeout_s)
        return self.states[-1]


@contextmanager
def another_node(name: str) -> Iterator[Node]:
    """A node in a context of its own, as of another process, spun in the background."""
    node = node_alone(name)
    spin = BackgroundSpin(node, name, owns_context=True)
    try:
        yield node
    finally:
        spin.close()


def _stamp_s(state: SupplyState) -> float:
    return state.header.stamp.sec + state.header.stamp.nanosec * 1e-9


def _claims_dead(state: SupplyState) -> bool:
    return state.mode in (Mode.STANDBY, Mode.ARMED) or OUTPUT_WORDS["grounded"] in state.fault_text


class DriverProcess:
    """Starts the node on a port; `log` collects what it prints."""

    def __init__(self, client: RosClient, port: str, **parameters: object) -> None:
        self._client = client
        client.states.clear()
        self._folder = tempfile.TemporaryDirectory(prefix="hasel_driver_")
        self.folder = Path(self._folder.name)
        self.history = self.folder / "history.jsonl"
        folders = dict.fromkeys(("recording_directory", "waveform_directory", "state_folder"), self.folder)
        own = {"history_file": self.history, **folders}
        chosen = {"port": port, "discovery_time": 0.2} | own | parameters
        arguments = [word for key, value in chosen.items() for word in ("-p", f"{key}:={value}")]
        self.process = subprocess.Popen(
            [sys.executable, "-m", "hasel_driver.nodes.driver_node", "--ros-args", *arguments],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self.log: list[str] = []
        self._reader = threading.Thread(
            target=lambda: self.log.extend(self.process.stdout or ()), daemon=True
        )
        self._reader.start()

    def arm(self) -> None:
        """From STANDBY; waits for the discovery time, and for publishers that are about to leave."""
        self._client.await_mode(Mode.STANDBY)
        for _ in range(20):
            answer = self._client.trigger("arm")
            if answer.success:
                self._client.command((0.0, 0.0))  # with which every controller begins
                return
            time.sleep(0.2)
        raise AssertionError(answer.message)

    def to_standby(self) -> None:
        """From whatever state, of the lifecycle too."""
        client = self._client
        client.activate()
        client.wait(lambda: bool(client.states), 10.0)
        client.trigger("disarm")
        client.states.clear()
        client.wait(lambda: bool(client.states))
        if client.state.mode == Mode.FAULT:
            client.trigger("clear_fault")
        self._client.await_mode(Mode.STANDBY)

    def close(self) -> None:
        """End the process, politely first, so that the graph forgets it."""
        self.process.terminate()
        try:
            self.process.wait(5.0)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()
        self._reader.join(timeout=5.0)
        self._folder.cleanup()
