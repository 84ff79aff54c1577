# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_sysid sysid`: how far the simulation is from the measurement, and the model that is nearer."""

import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

from hasel_common.declared_parameters import declare, words
from hasel_common.diagnostics import Diagnostics, Level, Part
from hasel_common.endpoints import STEADY, Role, frame_of, publisher, subscription
from hasel_common.managed_node import ManagedNode, start_and_spin
from hasel_common.node_process import end_at_once, run_node
from hasel_common.progress import HowFar, LogLines, Workload
from hasel_common.topics import DIAGNOSIS, ERROR, FIT, MEASURED, NAMESPACE, SIMULATED, STATE
from hasel_interfaces.msg import BendingAngle, Diagnosis, Fit, RunningError, SupplyState
from hasel_interfaces.srv import Diagnose, FitModel
from hasel_recording import Recording, RecordingError
from hasel_sim.errors import HaselSimError
from hasel_sim.live.live_simulator import live_model, within
from hasel_sim.live.simulator_interface import rig_voltage, to_nanoseconds
from hasel_sim.model import Model, save_model
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from std_msgs.msg import Header

from hasel_sysid.errors import SysidError
from hasel_sysid.expected_work import USUAL_SPEED
from hasel_sysid.live import running_error
from hasel_sysid.live.heard import Heard
from hasel_sysid.live.running_error import Epochs, Pair, Pairing, RunningErrors, StreamEpoch
from hasel_sysid.live.services import (
    chosen_recordings,
    diagnose_recordings,
    diagnosis_message,
    error_message,
    fit_message,
    fit_recordings,
    status,
)
from hasel_sysid.live.sysid_parameters import PARAMETERS

_Response = TypeVar("_Response", FitModel.Response, Diagnose.Response)


class SysidNode(ManagedNode):
    """Thin: pairs and sums up what it hears, and hands it to the fit in a thread of the service's own.

    Inactive, it hears nothing and fits nothing.
    """

    expected_errors = (HaselSimError,)

    def __init__(self) -> None:
        super().__init__("hasel_sysid", namespace=NAMESPACE)
        declare(self, PARAMETERS)
        gap, reset, late, window = (self._value(name) for name in ("gap", "reset", "late", "window"))
        epochs = Epochs()
        self._epoch = {topic: StreamEpoch(epochs, late) for topic in (STATE, MEASURED, SIMULATED)}
        self._pairing, self._heard = Pairing(gap), Heard(reset)
        self._errors = RunningErrors(reset, window)
        self._latest: running_error.RunningError | None = None
        self._pairs, self._busy = 0, threading.Lock()
        self._work: Workload | None = None
        self._lines: LogLines | None = None
        self._frame_id = frame_of(self, self._value("frame_id"))
        self._error = publisher(self, RunningError, ERROR, Role.EVERY_SAMPLE)
        self._fit = publisher(self, Fit, FIT, Role.RESULTS)
        self._diagnosis = publisher(self, Diagnosis, DIAGNOSIS, Role.RESULTS)
        self._diagnostics = Diagnostics(self, Part.IDENTIFICATION)
        hearing, working = MutuallyExclusiveCallbackGroup(), ReentrantCallbackGroup()
        self._inputs = {
            topic: subscription(self, kind, topic, handler, Role.EVERY_SAMPLE, callback_group=hearing)
            for kind, topic, handler in (
                (SupplyState, STATE, self._while_active(self._on_state)),
                (BendingAngle, MEASURED, self._while_active(self._on_measured)),
                (BendingAngle, SIMULATED, self._while_active(self._on_simulated)),
            )
        }
        self.create_timer(1.0, self._report, callback_group=hearing, clock=STEADY)
        self.create_service(FitModel, "fit", self._serve_fit, callback_group=working)
        self.create_service(Diagnose, "diagnose", self._serve_diagnosis, callback_group=working)

    def configure(self) -> None:
        """Refuse a model or effects that nothing could be fitted with."""
        self._model()

    def activate(self) -> None:
        """Say what is compared from now on."""
        simulated, measured = (self._inputs[topic].topic_name for topic in (SIMULATED, MEASURED))
        self.get_logger().info(f"Ready to compare {simulated} with {measured}.")

    def _while_active(self, handler: Callable[[Any], None]) -> Callable[[Any], None]:
        def hear(message: Any) -> None:
            if self.active:
                handler(message)

        return hear

    @property
    def doing(self) -> str:
        """What is being worked on, in a sentence; empty: nothing."""
        work = self._work
        return "" if work is None else str(work.now()) or "the request that came last"

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _on_state(self, message: SupplyState) -> None:
        stamp = to_nanoseconds(message.header.stamp)
        epoch, voltage = self._epoch[STATE].of(stamp), tuple(rig_voltage(message))
        self._heard.state(epoch, stamp, voltage)
        self._errors.state(epoch, stamp, voltage)

    def _on_measured(self, message: BendingAngle) -> None:
        stamp = to_nanoseconds(message.header.stamp)
        epoch = self._epoch[MEASURED].of(stamp)
        sine = message.sin_theta if message.valid else float("nan")
        self._heard.measured(epoch, stamp, sine)
        self._publish(self._pairing.measured(epoch, stamp, sine))

    def _on_simulated(self, message: BendingAngle) -> None:
        stamp = to_nanoseconds(message.header.stamp)
        self._publish(self._pairing.simulated(self._epoch[SIMULATED].of(stamp), stamp, message.sin_theta))

    def _publish(self, pairs: list[Pair]) -> None:
        for pair in pairs:
            self._latest = self._errors.add(pair)
            self._error.publish(error_message(pair.stamp_ns, self._latest, self._frame_id))
        self._pairs += len(pairs)

    def _report(self) -> None:
        latest = self._latest
        work, lines = self._work, self._lines
        sentence = self.doing or (
            "idle"
            if latest is None
            else f"mean |Δ sin θ| {latest.recent:.4f} in the last {latest.window:g} s, "
            f"{latest.mean_absolute:.4f} in this run so far"
        )
        values: dict[str, object] = {
            f"publishers of {heard.topic_name}": heard.get_publisher_count()
            for heard in self._inputs.values()
        }
        values["pairs"] = self._pairs
        if work is not None and lines is not None:
            lines.look()
            values |= _how_far(work.now())
        self._diagnostics.tell(Level.OK, sentence, values)

    def _serve_fit(self, request: FitModel.Request, response: FitModel.Response) -> FitModel.Response:
        def fit() -> str:
            model, recordings = self._model(), self._recordings(request.recordings)
            work = self._begin("fit")
            result = fit_recordings(model, recordings, request.method, self._value("jobs"), work)
            path = Path(self._value("output")) / f"{model.name}_fitted.yaml"
            save_model(result.model, path)
            response.fit = fit_message(result, str(path.resolve()), self._header())
            self._fit.publish(response.fit)
            return f"{result} Written to {path}; a simulator with own_files above it takes it by load_model."

        return self._serve(fit, response)

    def _serve_diagnosis(self, request: Diagnose.Request, response: Diagnose.Response) -> Diagnose.Response:
        def diagnose() -> str:
            effects = [within(self._value("own_files"), effect) for effect in request.effects if effect]
            model, recordings = self._model(), self._recordings(request.recordings)
            work = self._begin("diagnosis")
            found = diagnose_recordings(model, recordings, effects, self._value("jobs"), work)
            response.diagnosis = diagnosis_message(found, status(found), self._header())
            self._diagnosis.publish(response.diagnosis)
            return str(found)

        return self._serve(diagnose, response)

    def _begin(self, title: str) -> Workload:
        """What counts a work from now on, for `/diagnostics` and the log."""
        self._work = work = Workload(usual_speed=USUAL_SPEED)
        self._lines = LogLines(title, work.now, self.get_logger().info)
        return work

    def _header(self) -> Header:
        return Header(stamp=self.get_clock().now().to_msg(), frame_id=self._frame_id)

    def _model(self) -> Model:
        return live_model(self._value("model"), words(self, "effects"))[0]

    def _recordings(self, paths: list[str]) -> list[Recording]:
        return chosen_recordings(paths, [] if paths else self._heard.recordings())

    def _serve(self, action: Callable[[], str], response: _Response) -> _Response:
        """Answer with what `action` returns, one at a time; errors become sentences."""
        if not self.active:
            response.success, response.message = (
                False,
                "The node is not active: activate it (lifecycle) first.",
            )
            return response
        if not self._busy.acquire(blocking=False):
            response.success, response.message = False, f"busy ({self.doing}); ask again when that is done"
            return response
        self._work = Workload()
        try:
            response.message, response.success = action(), True
            self.get_logger().info(response.message)
        except (SysidError, HaselSimError, RecordingError, OSError) as error:
            response.message, response.success = str(error), False
            self.get_logger().warning(response.message)
        finally:
            self._work = self._lines = None
            self._busy.release()
        return response


def _how_far(now: HowFar) -> dict[str, object]:
    """What `/diagnostics` tells of a work under way; empty where nothing tells it yet."""
    return {
        "stage": now.stage,
        f"{now.units} done": now.done,
        f"{now.units} expected": now.of or "",
        "share": f"{now.share:.3f}",
        "time left [s]": "" if now.left_s is None else f"{now.left_s:.0f}",
    }


def main() -> None:
    """Run the node until it is interrupted, then end with its exit code; a fit under way is given up."""
    end_at_once(run_node(SysidNode, _spin, errors=(HaselSimError,)))


def _spin(node: SysidNode) -> None:
    try:
        start_and_spin(node, MultiThreadedExecutor(num_threads=3))
    finally:
        if node.doing:
            print(f"given up: {node.doing}", file=sys.stderr)


if __name__ == "__main__":
    main()
