# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_sim simulator`: the supply's state comes in, the simulated bending angle goes out at its stamps."""

import sys
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from hasel_common.declared_parameters import declare, words
from hasel_common.diagnostics import Diagnostics, Level, Part
from hasel_common.endpoints import STEADY, Role, frame_of, publisher, subscription
from hasel_common.managed_node import ManagedNode, start_and_spin
from hasel_common.node_process import RepeatedWarnings, run_node
from hasel_common.topics import NAMESPACE, SIMULATED, STATE, SWIMMER
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_interfaces.srv import AddEffect, LoadModel, RemoveEffect
from rclpy.exceptions import InvalidParameterValueException
from rclpy.subscription import Subscription
from threadpoolctl import threadpool_limits
from visualization_msgs.msg import MarkerArray

from hasel_sim.errors import HaselSimError, SimulationError
from hasel_sim.live.live_simulator import LiveAnswer, LiveSimulator, live_model, within
from hasel_sim.live.simulator_interface import (
    BodyMessage,
    ModelParameters,
    angle_message,
    rig_voltage,
    to_nanoseconds,
)
from hasel_sim.live.simulator_parameters import PARAMETERS
from hasel_sim.model import Model
from hasel_sim.parameter import value_with_error

_Response = TypeVar("_Response", AddEffect.Response, RemoveEffect.Response, LoadModel.Response)


@dataclass(frozen=True)
class PaceReport:
    """real_time_factor: simulated over computing time, NaN before there is any; lags [s] from reception to answer."""

    messages: int
    real_time_factor: float
    mean_lag: float
    worst_lag: float

    @property
    def behind(self) -> bool:
        """Whether messages come faster than they are answered."""
        return self.real_time_factor < 1.0 or self.worst_lag > 0.1

    def __str__(self) -> str:
        if self.messages == 0:
            return "no state message in the last second"
        return (
            f"{self.real_time_factor:.1f} times real time, answers after {1e3 * self.mean_lag:.1f} ms"
            f" (at worst {1e3 * self.worst_lag:.1f} ms)"
        )


class Pace:
    """Collects what each message took, between two reports."""

    def __init__(self) -> None:
        self._rows: list[tuple[float, float, float]] = []

    def add(self, simulated: float, computing: float, lag: float) -> None:
        """One message: time simulated, time spent on it, time from its reception to the answer [s]."""
        self._rows.append((simulated, computing, lag))

    def report(self) -> PaceReport:
        """Sum up since the last report."""
        rows, self._rows = np.array(self._rows).reshape(-1, 3), []
        if len(rows) == 0:
            return PaceReport(0, np.nan, np.nan, np.nan)
        simulated, computing, _ = rows.sum(axis=0)
        factor = simulated / computing if simulated > 0 else np.nan
        return PaceReport(len(rows), float(factor), float(rows[:, 2].mean()), float(rows[:, 2].max()))


class SimulatorNode(ManagedNode):
    """Thin: all that is simulated happens in `LiveSimulator`. Inactive, it has its model and hears no state."""

    expected_errors = (HaselSimError, InvalidParameterValueException)

    def __init__(self) -> None:
        super().__init__("hasel_simulator", namespace=NAMESPACE)
        self._warnings = RepeatedWarnings()
        declare(self, PARAMETERS)
        self.model_parameters = ModelParameters(self, self._use)
        self._live: LiveSimulator | None = None
        self._states: Subscription | None = None
        self._frame_id = frame_of(self, self._value("frame_id"))
        self._pace = Pace()
        self._counts: Counter[str] = Counter()
        self._next_angle_ns = self._next_shape_s = 0
        self._angles = publisher(self, BendingAngle, SIMULATED, Role.EVERY_SAMPLE)
        self._shapes = publisher(self, MarkerArray, SWIMMER, Role.SHAPES)
        self._diagnostics = Diagnostics(self, Part.SIMULATION)
        self.create_service(AddEffect, "add_effect", self._add_effect)
        self.create_service(RemoveEffect, "remove_effect", self._remove_effect)
        self.create_service(LoadModel, "load_model", self._load_model)
        self.create_timer(1.0, self._report, clock=STEADY)

    @property
    def live(self) -> LiveSimulator:
        """The simulation. Raises SimulationError where the node has not been configured."""
        if self._live is None:
            raise SimulationError("no model has been built: configure the node (lifecycle) first")
        return self._live

    # Lifecycle

    def configure(self) -> None:
        """Build the model and compile what simulates it."""
        model, warning = live_model(self._value("model"), words(self, "effects"))
        self._warn(warning)
        options = {name: self._value(name) for name in ("history", "gap", "reset", "late", "load_factor")}
        model = self.model_parameters.declare(model)
        self._live = LiveSimulator(model, **options)
        compiled = LiveSimulator(model, **options)  # and all loaded, before the first message
        for stamp_ns in (0, 8_000_000, 16_000_000):
            compiled.receive(stamp_ns, np.zeros(2))
        self._body = BodyMessage(self._live.mesh, len(self._live.markers), self._frame_id)

    def activate(self) -> None:
        """Listen to the supply's state."""
        self._states = subscription(self, SupplyState, STATE, self._on_state, Role.EVERY_SAMPLE)
        self.get_logger().info(
            f"Simulating model '{self.live.model.name}', ready for {self._states.topic_name}."
        )

    def deactivate(self) -> None:
        """Hear no state any more; the next one starts from rest."""
        if self._states is not None:
            self.destroy_subscription(self._states)
            self._states = None
        if self._live is not None:
            self._live.restart()

    def cleanup(self) -> None:
        """Forget the model and its parameters."""
        self.model_parameters.forget()
        self._live = None

    def _value(self, name: str) -> Any:
        return self.get_parameter(name).value

    def _warn(self, sentence: str) -> None:
        sentence = sentence and self._warnings.to_say(sentence, time.monotonic())
        if sentence:
            self.get_logger().warning(sentence[:1].upper() + sentence[1:] + ".")

    # Topics

    def _on_state(self, state: SupplyState, info: dict[str, Any]) -> None:
        begun = time.perf_counter()
        answer = self.live.receive(to_nanoseconds(state.header.stamp), rig_voltage(state))
        self._publish(answer)
        waited = (time.time_ns() - info["received_timestamp"]) * 1e-9
        self._pace.add(answer.simulated, time.perf_counter() - begun, max(0.0, waited))
        self._counts[answer.arrival.value] += 1
        self._warn(answer.sentence)

    def _publish(self, answer: LiveAnswer) -> None:
        rate = self._value("rate")
        for angle in answer.angles:
            early = angle.stamp_ns < self._next_angle_ns and answer.arrival.value == "next"
            if rate > 0 and early:
                continue
            self._angles.publish(angle_message(angle.stamp_ns, angle.sin_theta, self._frame_id))
            self._next_angle_ns = angle.stamp_ns + (int(1e9 / rate) if rate > 0 else 0)
        shape_rate, now = self._value("shape_rate"), time.monotonic()
        if (
            answer.angles
            and shape_rate > 0
            and now >= self._next_shape_s
            and self._shapes.get_subscription_count()
        ):
            stamp_ns = answer.angles[-1].stamp_ns
            self._shapes.publish(self._body.moved(stamp_ns, self.live.position, self.live.markers))
            self._next_shape_s = now + 1.0 / shape_rate

    def _report(self) -> None:
        pace, counts = self._pace.report(), self._counts
        if not self.active:
            state = "inactive" if self._live is not None else "unconfigured"
            self._diagnostics.tell(Level.OK, f"{state}: nothing is simulated", {})
            return
        values = {
            "model": self.live.model.name,
            "effects": ", ".join(effect.id for effect in self.live.model.effects) or "none",
            "real-time factor": f"{pace.real_time_factor:.2f}",
            "mean lag [ms]": f"{1e3 * pace.mean_lag:.2f}",
            "worst lag [ms]": f"{1e3 * pace.worst_lag:.2f}",
            "state messages in the last second": pace.messages,
            "held: late or repeated messages": counts["held"],
            "gaps bridged": counts["gap"],
            "runs started": counts["start"] + counts["restart"],
        }
        well = not (pace.behind or counts["held"] or counts["gap"])
        self._diagnostics.tell(Level.OK if well else Level.WARN, str(pace), values)
        self._counts = Counter({name: counts[name] for name in ("start", "restart")})

    def _use(self, model: Model) -> None:
        before = self.live.mesh
        self.live.use(model)
        if self.live.mesh is not before:
            self._body = BodyMessage(self.live.mesh, len(self.live.markers), self._frame_id)

    # Services

    def _add_effect(self, request: AddEffect.Request, response: AddEffect.Response) -> AddEffect.Response:
        def add() -> str:
            model = self.live.model.with_effects(within(self._value("own_files"), request.effect))
            added = model.effects[-1]
            names = [
                f"parameters.{added.id}.{p.name} (typically {value_with_error(p.typical, None, p.unit)})"
                for p in added.parameters
            ]
            self._change(model)
            return f"Effect '{added.id}' is in the model, so far without influence: set {', '.join(names)}."

        return self._serve(add, response)

    def _remove_effect(
        self, request: RemoveEffect.Request, response: RemoveEffect.Response
    ) -> RemoveEffect.Response:
        def remove() -> str:
            self._change(self.live.model.without_effects(request.effect))
            return f"Effect '{request.effect}' is out of the model."

        return self._serve(remove, response)

    def _load_model(self, request: LoadModel.Request, response: LoadModel.Response) -> LoadModel.Response:
        def load() -> str:
            _ = self.live  # configured
            model, warning = live_model(within(self._value("own_files"), request.model))
            self._warn(warning)
            self._change(model)
            return f"Model '{model.name}' is simulated from now on."

        return self._serve(load, response)

    def _change(self, model: Model) -> None:
        self._use(model)
        self.model_parameters.declare(model)

    def _serve(self, action: Callable[[], str], response: _Response) -> _Response:
        try:
            response.message, response.success = action(), True
            self.get_logger().info(response.message)
        except HaselSimError as error:
            response.message, response.success = str(error), False
            self._warn(response.message)
        return response


def main() -> int:
    """Run the node until it is interrupted; returns the exit code."""
    with threadpool_limits(1):
        return run_node(SimulatorNode, start_and_spin, errors=(HaselSimError,))


if __name__ == "__main__":
    sys.exit(main())
