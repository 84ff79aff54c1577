"""`ros2 run hasel_bringup recorder`: one MCAP file per run, of everything that is said about it.

While it is written a recording is called NAME.mcap.part; what was interrupted becomes NAME_interrupted.mcap.
"""

import math
from collections.abc import Callable
from functools import partial
from pathlib import Path

from hasel_common.declared_parameters import declare
from hasel_common.endpoints import Role, subscription
from hasel_common.inside_folder import inside_folder
from hasel_common.managed_node import ManagedNode, start_and_spin
from hasel_common.provenance import provenance
from hasel_common.topics import ERROR, MEASURED, NAMESPACE, SIMULATED, STATE, relative
from hasel_interfaces.msg import BendingAngle, RunningError, SupplyState
from hasel_recording import RecordingError
from hasel_recording.mcap_recorder import McapRecorder
from hasel_recording.ros_messages import nanoseconds
from hasel_sim.node_process import run_node
from std_srvs.srv import Trigger

from hasel_bringup.errors import BringupError
from hasel_bringup.recorder.other_nodes import OtherNodes
from hasel_bringup.recorder.recorder_parameters import PARAMETERS

RECORDED = {STATE: SupplyState, MEASURED: BendingAngle, SIMULATED: BendingAngle, ERROR: RunningError}
PACKAGES = ("hasel_recording", "hasel_driver", "hasel_tracker", "hasel_sim", "hasel_sysid", "hasel_bringup")


class RecorderNode(ManagedNode):
    """Active, it records from the service recorder/start to recorder/stop."""

    def __init__(self) -> None:
        super().__init__("hasel_recorder", namespace=NAMESPACE)
        declare(self, PARAMETERS)
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

    def _value(self, name: str):
        return self.get_parameter(name).value

    def _write(self, name: str, message) -> None:
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
        self._path = _path(self._value("folder"), self._value("name"))
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
        self._finish(self._path)
        return str(self._path)

    @property
    def _part(self) -> Path:
        return self._path.with_name(f"{self._path.name}.part")

    def _finish(self, path: Path) -> None:
        recorder, self._recorder = self._recorder, None
        recorder.describe({**self._provenance(), **self._made_by})  # with what nodes have answered since
        recorder.close()
        self._part.rename(path)

    def deactivate(self) -> None:
        """Finish what is being recorded, as interrupted."""
        self._interrupt()

    def _interrupt(self) -> None:
        if self._recorder is not None:
            self._finish(self._path.with_name(f"{self._path.stem}_interrupted.mcap"))

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
        self._interrupt()
        super().destroy_node()


def _path(folder: str, name: str) -> Path:
    try:
        path = inside_folder(folder, name)
        if path.name != name:
            raise ValueError(f"{name!r} is no file of {folder} itself")
    except ValueError as error:
        raise BringupError(f"name: {error}; a name without folders is expected: set one.") from None
    return path.with_name(f"{name}.mcap")


def _is_unknown(message) -> bool:
    """Whether this is the state of a supply that does not know its voltage: no sample of it."""
    return isinstance(message, SupplyState) and not all(map(math.isfinite, message.commanded_voltage))


def main() -> int:
    """Run the node until it is interrupted; returns the exit code."""
    return run_node(RecorderNode, start_and_spin, errors=(BringupError, RecordingError))
