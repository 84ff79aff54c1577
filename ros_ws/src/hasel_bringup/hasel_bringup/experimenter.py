# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What an experimenter does with the rig's nodes: services, the action, parameters, and the error on its topic."""

import math
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from typing import Any

from hasel_common.endpoints import Role, subscription
from hasel_common.managed_node import BackgroundSpin, node_alone
from hasel_common.topics import ERROR, MEASURED, NAMESPACE, SIMULATED, STATE, relative
from hasel_interfaces.action import RunExperiment
from hasel_interfaces.msg import BendingAngle, RunningError, SupplyState
from lifecycle_msgs.msg import Transition
from lifecycle_msgs.srv import ChangeState
from rcl_interfaces.srv import SetParameters
from rclpy.action import ActionClient
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from hasel_bringup.errors import BringupError

_START_S = 120.0
_ANSWER_S = 60.0
_TO_REST = {
    "hasel_driver": (Transition.TRANSITION_DEACTIVATE, Transition.TRANSITION_CLEANUP),
    "hasel_simulator": (Transition.TRANSITION_DEACTIVATE,),
    "hasel_tracker": (Transition.TRANSITION_DEACTIVATE,),
}
_TO_WORK = {
    "hasel_tracker": (Transition.TRANSITION_ACTIVATE,),
    "hasel_simulator": (Transition.TRANSITION_ACTIVATE,),
    "hasel_driver": (Transition.TRANSITION_CONFIGURE, Transition.TRANSITION_ACTIVATE),
}
_CONNECTED = ("hasel_simulator", "hasel_sysid", "hasel_recorder", "hasel_virtual_camera")


class ExperimentFailedError(BringupError):
    """The supply stopped itself in the middle of a run, or the run's recording is not whole."""


class Experimenter:
    """A node of its own, spun in the background, in the namespace of the rig.

    check: called while waiting; raises when a process has ended. domain: of ROS; None: the user's. hint: what to do
    where something does not come in time.
    """

    def __init__(
        self,
        check: Callable[[], None],
        domain: int | None = None,
        name: str = "hasel_live_demo",
        hint: str = "",
    ) -> None:
        self._check, self._hint = check, hint
        self.node = node_alone(name, NAMESPACE, domain)
        self.error = RunningError()
        self.measured = 0
        subscription(self.node, RunningError, ERROR, self._on_error, Role.EVERY_SAMPLE)
        subscription(self.node, BendingAngle, MEASURED, self._on_measured, Role.EVERY_SAMPLE)
        self.state: SupplyState | None = None
        subscription(self.node, SupplyState, STATE, self._on_state, Role.SAMPLES)
        self._actions = ActionClient(self.node, RunExperiment, "run_experiment")
        self._clients: dict[str, Any] = {}
        self._spin = BackgroundSpin(self.node, "rig", owns_context=True)

    @property
    def error_topic(self) -> str:
        """The full name of the live error's topic."""
        return self.node.resolve_topic_name(relative(ERROR))

    def close(self) -> None:
        """Leave the graph."""
        self._spin.close()

    def await_nodes(self) -> None:
        """Wait until everybody hears everybody. Raises BringupError when that does not happen."""
        hearers = {STATE: _CONNECTED, MEASURED: ("hasel_sysid", "hasel_recorder", "hasel_virtual_camera")}
        for topic, names in (*hearers.items(), (SIMULATED, ("hasel_sysid",))):
            name = self.node.resolve_topic_name(relative(topic))
            self.until(
                partial(self._hear, name, set(names)),
                _START_S,
                f"{', '.join(names)} did not all come to hear {name}",
            )
        self.until(lambda: self.state is not None, _START_S, "the driver says nothing of its supply")

    def _hear(self, topic: str, names: set[str]) -> bool:
        return names <= {info.node_name for info in self.node.get_subscriptions_info_by_topic(topic)}

    def trigger(self, name: str, kind: type = Trigger, seconds: float = _ANSWER_S, **request: Any) -> str:
        """Call a service and return its words. Raises BringupError with them where it refuses."""
        answer = self.call(kind, name, seconds, **request)
        if not answer.success:
            raise BringupError(f"{name}: {answer.message}")
        return answer.message

    def call(self, kind: Any, name: str, seconds: float = _ANSWER_S, **request: Any) -> Any:
        """Call a service and return its answer."""
        if name not in self._clients:
            self._clients[name] = self.node.create_client(kind, name)
        client = self._clients[name]
        self.until(client.service_is_ready, _START_S, f"nobody offers {client.srv_name}")
        future = client.call_async(kind.Request(**request))
        self.until(future.done, seconds, f"{client.srv_name} did not answer")
        return future.result()

    def set_parameters(self, node: str, values: Mapping[str, Any]) -> None:
        """Set parameters of a node of the rig. Raises BringupError where one is refused."""
        parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in values.items()]
        answer = self.call(SetParameters, f"{node}/set_parameters", parameters=parameters)
        for name, result in zip(values, answer.results, strict=True):
            if not result.successful:
                raise BringupError(f"{node} refuses {name} = {values[name]}: {result.reason}")

    @contextmanager
    def resting(self) -> Iterator[None]:
        """Meanwhile the supply's port is closed and nothing is simulated or tracked: the machine is free."""
        for node, transitions in _TO_REST.items():
            self._change(node, transitions)
        yield
        for node, transitions in _TO_WORK.items():
            self._change(node, transitions)

    def _change(self, node: str, transitions: Sequence[int]) -> None:
        for transition in transitions:
            request = {"transition": Transition(id=transition)}
            if not self.call(ChangeState, f"{node}/change_state", **request).success:
                raise BringupError(f"{node} refuses the lifecycle's transition {transition}; see its output")

    def arm(self) -> str:
        """Arm, and return what fault had to be cleared before, if any; waits where the driver does.

        A virtual board that this machine held up too long has stopped itself, as a real one does.
        """
        self.until(self._actions.server_is_ready, _START_S, "nobody offers run_experiment")
        end, cleared = time.monotonic() + _ANSWER_S, ""
        while not (answer := self.call(Trigger, "arm")).success:
            if time.monotonic() > end:
                raise BringupError(f"the driver does not arm: {answer.message}")
            if self.state is not None and self.state.mode == SupplyState.FAULT:
                cleared = self.state.fault_text
                self.call(Trigger, "clear_fault")
            self.pause(0.5)
        return cleared

    def run_experiment(self, goal: Mapping[str, Any], seconds: float) -> None:
        """Drive the muscles. Raises BringupError when it fails."""
        sent = self._actions.send_goal_async(RunExperiment.Goal(**goal))
        self.until(sent.done, _ANSWER_S, "run_experiment did not answer")
        if not sent.result().accepted:
            raise BringupError("the driver refuses the experiment: another one is running")
        future = sent.result().get_result_async()
        self.until(future.done, seconds + _ANSWER_S, "the experiment did not end")
        if not (result := future.result().result).success:
            raise ExperimentFailedError(f"the experiment failed: {result.message}")

    def await_frames(self, count: int, since: int) -> int:
        """Wait until `count` frames after the first `since` were tracked; how many were lost if some do not come."""
        with suppress(BringupError):
            self.until(lambda: self.measured - since >= count, 10.0, "")
        return max(0, count - (self.measured - since))

    def pause(self, seconds: float) -> None:
        """Wait, and notice meanwhile when a process ends."""
        end = time.monotonic() + seconds
        self.until(lambda: time.monotonic() > end, math.inf, "")

    def until(self, condition: Callable[[], object], seconds: float, failure: str) -> None:
        """Wait for something. Raises BringupError when it does not come in time, or a process ends."""
        end = time.monotonic() + seconds
        while not condition():
            self._check()
            if time.monotonic() > end:
                raise BringupError(f"{failure} within {seconds:g} s{self._hint}")
            time.sleep(0.02)

    def _on_error(self, error: RunningError) -> None:
        self.error = error

    def _on_measured(self, _: BendingAngle) -> None:
        self.measured += 1

    def _on_state(self, state: SupplyState) -> None:
        self.state = state
