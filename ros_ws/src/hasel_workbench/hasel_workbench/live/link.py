# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The node of the workbench, spun in a thread of its own: hears the rig, asks its services."""

import asyncio
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from hasel_common.endpoints import Role, subscription
from hasel_common.managed_node import BackgroundSpin, node_alone
from hasel_common.topics import MEASURED, SIMULATED, STATE
from hasel_interfaces.action import RunExperiment
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_interfaces.srv import LoadModel
from hasel_sim.live.simulator_interface import rig_voltage, to_nanoseconds
from hasel_sysid.errors import SysidError
from rclpy.action import ActionClient
from std_srvs.srv import Trigger

from hasel_workbench.jobs import Progress
from hasel_workbench.live.stream import KINDS, LiveStream

_STOP_S, _ANSWER_S, _LOOK_S = 1.0, 30.0, 0.05


class RigLink:
    """state: what the supply said last; heard_at: when each kind of sample came last, of the monotonic clock [s];
    domain: of ROS, else the user's.
    """

    def __init__(self, stream: LiveStream, namespace: str, domain: int | None = None) -> None:
        self.state: SupplyState | None = None
        self.heard_at = dict.fromkeys(KINDS, float("-inf"))
        self._stream = stream
        self._node = node_alone("hasel_workbench", namespace, domain)
        subscription(self._node, SupplyState, STATE, self._on_state, Role.SAMPLES)
        subscription(self._node, BendingAngle, MEASURED, self._on_measured, Role.SAMPLES)
        subscription(self._node, BendingAngle, SIMULATED, self._on_simulated, Role.SAMPLES)
        self._stop = self._node.create_client(Trigger, "emergency_stop")
        self._load = self._node.create_client(LoadModel, "load_model")
        self._experiments = ActionClient(self._node, RunExperiment, "run_experiment")
        self._spin = BackgroundSpin(self._node, "rig", owns_context=True)

    def close(self) -> None:
        """Leave the graph."""
        self._spin.close()

    @property
    def has_simulator(self) -> bool:
        """Whether somebody offers to load a model."""
        return self._load.service_is_ready()

    async def stop(self) -> str:
        """Ask for the emergency stop; what the driver answered."""
        if not self._stop.service_is_ready():
            return f"nobody offers {self._stop.srv_name}: use the mushroom switch"
        future = self._stop.call_async(Trigger.Request())
        end = time.monotonic() + _STOP_S
        while not future.done():
            if time.monotonic() > end:
                return f"{self._stop.srv_name} did not answer: use the mushroom switch"
            await asyncio.sleep(0.01)
        return future.result().message

    def load(self, model: Path) -> str:
        """Let the simulator take a model file. Raises SysidError."""
        answer = self._answer(self._load.call_async(LoadModel.Request(model=str(model.resolve()))))
        if not answer.success:
            raise SysidError(answer.message)
        return answer.message

    def run(self, goal: Mapping[str, Any], progress: Progress) -> str:
        """Have a run made; its recording's path and what was said. Raises SysidError.

        Where `progress` raises, the run is cancelled: the driver ramps down and grounds.
        """
        if not self._experiments.server_is_ready():
            raise SysidError("nobody offers run_experiment; start the driver first")

        def shown(message: Any) -> None:
            self._share = message.feedback.progress

        self._share = 0.0
        sent = self._experiments.send_goal_async(RunExperiment.Goal(**goal), feedback_callback=shown)
        handle = self._answer(sent)
        if not handle.accepted:
            raise SysidError("the driver refuses the run; arm it with its own tools, and see what it says")
        result = handle.get_result_async()
        try:
            while not result.done():
                progress("the run is being made", self._share)
                time.sleep(_LOOK_S)
        except BaseException:
            handle.cancel_goal_async()
            raise
        answer = result.result().result
        if not answer.success:
            raise SysidError(f"the run failed: {answer.message}")
        return f"{answer.message} {answer.recording}"

    def _answer(self, future: Any) -> Any:
        end = time.monotonic() + _ANSWER_S
        while not future.done():
            if time.monotonic() > end:
                raise SysidError(f"no answer within {_ANSWER_S:g} s; is the rig still there?")
            time.sleep(_LOOK_S)
        return future.result()

    def _on_state(self, message: SupplyState) -> None:
        self.state, self.heard_at["voltage"] = message, time.monotonic()
        self._stream.voltage(to_nanoseconds(message.header.stamp), tuple(rig_voltage(message)))

    def _on_measured(self, message: BendingAngle) -> None:
        self.heard_at["measured"] = time.monotonic()
        sine = message.sin_theta if message.valid else float("nan")
        self._stream.measured(to_nanoseconds(message.header.stamp), sine)

    def _on_simulated(self, message: BendingAngle) -> None:
        self.heard_at["simulated"] = time.monotonic()
        self._stream.simulated(to_nanoseconds(message.header.stamp), message.sin_theta)
