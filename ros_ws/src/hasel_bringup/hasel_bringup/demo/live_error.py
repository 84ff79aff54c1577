"""Simulator, identification and replay as three processes on DDS, and the error they come to."""

import time
from collections.abc import Callable
from pathlib import Path

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from hasel_common.endpoints import Role, subscription
from hasel_common.managed_node import node_alone
from hasel_common.topics import DIAGNOSTICS, ERROR, NAMESPACE, SIMULATED
from hasel_interfaces.msg import RunningError
from hasel_interfaces.srv import LoadModel
from rclpy.executors import SingleThreadedExecutor

from hasel_bringup.demo.processes import Processes
from hasel_bringup.errors import BringupError

_PATIENCE_S = 60.0


class LiveError:
    """As a context manager, starts simulator and identification; `of` replays a recording through them.

    domain: a ROS domain of its own, so that no rig in the house hears the replay.
    """

    def __init__(self, model: Path, folder: Path, domain: int) -> None:
        self._model, self._folder, self._domain = model, folder, domain
        environment = {"ROS_DOMAIN_ID": str(domain), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        self._processes = Processes(folder, environment)
        self._connected = False
        self._last, self._compared = RunningError(), 0

    def __enter__(self) -> "LiveError":
        self._node = node_alone("hasel_demo", NAMESPACE, self._domain)
        self._executor = SingleThreadedExecutor(context=self._node.context)
        self._executor.add_node(self._node)
        subscription(self._node, RunningError, ERROR, self._on_error, Role.EVERY_SAMPLE)
        subscription(self._node, DiagnosticArray, DIAGNOSTICS, self._on_diagnostics, Role.DIAGNOSTICS)
        model = ("--ros-args", "-p", f"model:={self._model}")
        self._processes.start("hasel_sim", "simulator", *model, "-p", f"own_files:={self._folder}")
        self._processes.start("hasel_sysid", "sysid", *model)
        try:
            self._until(lambda: self._connected, "simulator and sysid did not find each other")
        except BringupError:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._processes.__exit__()
        self._executor.shutdown()
        self._node.destroy_node()
        rclpy.try_shutdown(context=self._node.context)

    def load(self, model: Path) -> None:
        """Let the running simulator go on with another model. Raises BringupError when it refuses."""
        client = self._node.create_client(LoadModel, "load_model")
        self._until(client.service_is_ready, "the simulator does not offer load_model")
        future = client.call_async(LoadModel.Request(model=str(model)))
        self._until(future.done, "the simulator did not answer")
        if not future.result().success:
            raise BringupError(future.result().message)

    def of(self, recording: Path, frames: int, rate: str = "1") -> float:
        """Mean |Δ sin θ| over the frames of a recording, as published at its last frame."""
        self._compared = 0
        listeners = ("--expect", "hasel_simulator", "hasel_sysid")
        self._processes.start("hasel_bringup", "replay", str(recording), "--rate", rate, *listeners)
        self._until(lambda: self._compared == frames, f"not all {frames} frames were compared")
        self._processes.finish("replay", _PATIENCE_S)
        return self._last.mean_absolute_error

    def _on_error(self, message: RunningError) -> None:
        self._last, self._compared = message, self._compared + 1

    def _on_diagnostics(self, message: DiagnosticArray) -> None:
        for status in message.status:
            values = {pair.key: pair.value for pair in status.values}
            self._connected |= values.get(f"publishers of {SIMULATED}", "0") != "0"

    def _until(self, condition: Callable[[], object], failure: str) -> None:
        end = time.monotonic() + _PATIENCE_S
        while not condition():
            if time.monotonic() > end:
                raise BringupError(
                    f"{failure} within {_PATIENCE_S:g} s; is a firewall between local processes? "
                    f"see {self._processes.output('simulator')}"
                )
            self._processes.check()
            self._executor.spin_once(timeout_sec=0.05)
