# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_bringup recorder`: one MCAP file per run, of everything that is said about it.

While it is written a recording is called NAME.mcap.part; what was interrupted becomes NAME_interrupted.mcap.
"""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import TypeAlias

from hasel_common.declared_parameters import declare
from hasel_common.endpoints import Role, subscription
from hasel_common.inside_folder import inside_folder
from hasel_common.managed_node import ManagedNode, start_and_spin
from hasel_common.node_process import run_node
from hasel_common.provenance import provenance
from hasel_common.topics import ERROR, MEASURED, NAMESPACE, SIMULATED, STATE, relative
from hasel_interfaces.msg import BendingAngle, RunningError, SupplyState
from hasel_recording import RecordingError
from hasel_recording.mcap_recorder import McapRecorder
from hasel_recording.ros_messages import nanoseconds
from rcl_interfaces.srv import GetParameters, ListParameters
from rclpy.client import Client
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python
from rclpy.task import Future
from std_srvs.srv import Trigger

from hasel_bringup.bringup_parameters import RECORDER
from hasel_bringup.errors import BringupError

RECORDED = {STATE: SupplyState, MEASURED: BendingAngle, SIMULATED: BendingAngle, ERROR: RunningError}
PACKAGES = ("hasel_recording", "hasel_driver", "hasel_tracker", "hasel_sim", "hasel_sysid", "hasel_bringup")
_ASKED_EVERY_S = 1.0
_INTERNAL = ("qos_overrides.", "start_type_description_service", "use_sim_time")
_SECRETIVE = "hasel_virtual_camera"  # what it hides is not for recordings

_Message: TypeAlias = SupplyState | BendingAngle | RunningError


class RecorderNode(ManagedNode):
    """Active, it records from the service recorder/start to recorder/stop."""

    def __init__(self) -> None:
        super().__init__("hasel_recorder", namespace=NAMESPACE)
        declare(self, RECORDER)
        self._recorder: McapRecorder | None = None
        self._path = Path()
        self._made_by: dict[str, str] = {}
        self._last_ns: dict[str, int] = {}
        self._others = OtherNodes(self)
        for topic, kind in RECORDED.items():
            name = self.resolve_topic_name(relative(topic))
            subscription(self, kind, topic, partial(self._write, name), Role.EVERY_SAMPLE)
        self.create_service(Trigger, "recorder/start", partial(self._serve, self._start))
        self.create_service(Trigger, "recorder/stop", partial(self._serve, self._stop))

    def _write(self, name: str, message: _Message) -> None:
        if self._recorder is None or _is_unknown(message):
            return
        stamp_ns = nanoseconds(message.header.stamp)
        if stamp_ns > self._last_ns.get(name, -1):
            self._last_ns[name] = stamp_ns
            self._recorder.write(name, message, stamp_ns)

    def _start(self) -> str:
        if not self.active:
            raise BringupError("The recorder is not active: activate it (lifecycle) first.")
        if self._recorder is not None:
            raise BringupError(f"{self._path} is being recorded: stop that first (recorder/stop).")
        self._path = _path(*(self.get_parameter(name).value for name in ("folder", "name")))
        self._path.parent.mkdir(parents=True, exist_ok=True)
        if self._path.exists():
            raise BringupError(
                f"{self._path} exists already, and no recording is overwritten: set another name."
            )
        self._last_ns = {}
        self._made_by = self._provenance()
        self._recorder = McapRecorder(self._part, self._made_by)
        return str(self._path)

    def _provenance(self) -> dict[str, str]:
        return provenance(self.get_fully_qualified_name(), PACKAGES, self._others.known())

    def _stop(self) -> str:
        if self._recorder is None:
            raise BringupError("Nothing is being recorded: start it first (recorder/start).")
        self._finish(self._recorder, self._path)
        return str(self._path)

    @property
    def _part(self) -> Path:
        return self._path.with_name(f"{self._path.name}.part")

    def _finish(self, recorder: McapRecorder, path: Path) -> None:
        self._recorder = None
        recorder.describe({**self._provenance(), **self._made_by})  # with what nodes have answered since
        recorder.close()
        self._part.rename(path)

    def deactivate(self) -> None:
        """Finish what is being recorded, as interrupted."""
        if self._recorder is not None:
            self._finish(self._recorder, self._path.with_name(f"{self._path.stem}_interrupted.mcap"))

    def _serve(
        self, action: Callable[[], str], _: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        try:
            response.message, response.success = action(), True
        except (BringupError, RecordingError, OSError) as error:
            response.message = str(error)
            self.get_logger().error(response.message)
        return response

    def destroy_node(self) -> None:
        """Finish what is being recorded and leave."""
        self.deactivate()
        super().destroy_node()


def _path(folder: str, name: str) -> Path:
    try:
        path = inside_folder(folder, name)
        if path.name != name:
            raise ValueError(f"{name!r} is no file of {folder} itself")
    except ValueError as error:
        raise BringupError(f"name: {error}; a name without folders is expected: set one.") from None
    return path.with_name(f"{name}.mcap")


def _is_unknown(message: _Message) -> bool:
    """Whether this is the state of a supply that does not know its voltage: no sample of it."""
    return isinstance(message, SupplyState) and not all(map(math.isfinite, message.commanded_voltage))


class OtherNodes:
    """Asks in the background for the parameters of this node's namespace; `known()` gives what was answered last."""

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients: dict[str, tuple[Client, Client]] = {}  # kept: a new one needs time to find its service
        self._values: dict[str, dict[str, object]] = {}
        node.create_timer(_ASKED_EVERY_S, self._ask)

    def known(self) -> dict[str, object]:
        """The values, at most some seconds old, as {node.parameter: value}."""
        return {
            f"{node}.{name}": value
            for node, values in sorted(self._values.items())
            for name, value in sorted(values.items())
        }

    def _ask(self) -> None:
        here = self._node.get_namespace()
        for name, namespace in self._node.get_node_names_and_namespaces():
            if (
                namespace == here
                and name.startswith("hasel_")
                and name not in (self._node.get_name(), _SECRETIVE)
            ):
                self._list(name)

    def _list(self, name: str) -> None:
        if name not in self._clients:
            self._clients[name] = (
                self._node.create_client(ListParameters, f"{name}/list_parameters"),
                self._node.create_client(GetParameters, f"{name}/get_parameters"),
            )
        lister, getter = self._clients[name]
        if not (lister.service_is_ready() and getter.service_is_ready()):
            return

        def listed(future: Future) -> None:
            names = [n for n in future.result().result.names if not n.startswith(_INTERNAL)]
            self._get(name, names)

        lister.call_async(ListParameters.Request()).add_done_callback(listed)

    def _get(self, name: str, names: list[str]) -> None:
        def got(future: Future) -> None:
            values = map(parameter_value_to_python, future.result().values)
            self._values[name] = dict(zip(names, values, strict=False))

        getter = self._clients[name][1]
        getter.call_async(GetParameters.Request(names=names)).add_done_callback(got)


def main() -> int:
    """Run the node until it is interrupted; returns the exit code."""
    return run_node(RecorderNode, start_and_spin, errors=(BringupError, RecordingError))
