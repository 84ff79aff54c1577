# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_driver driver_node`: lifecycle node, whose safety process talks to the supply."""

import math
import os
import signal
import sys
import threading
import time
from typing import Any

import rclpy
from hasel_common.command_entry import end_at_once_with_parent
from hasel_common.diagnostics import Diagnostics, Part
from hasel_common.endpoints import Role, frame_of, publisher
from hasel_common.managed_node import quiet_at_shutdown, spin
from hasel_common.topics import NAMESPACE, STATE
from hasel_interfaces.msg import SupplyState
from rclpy._rclpy_pybind11 import RCLError, RCLInvalidROSArgsError
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.exceptions import ParameterException
from rclpy.executors import MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.signals import SignalHandlerOptions

from hasel_driver.nodes.driver_services import (
    SERVICES,
    DriverServices,
    sentence,
    supply_health,
    to_supply_state,
)
from hasel_driver.nodes.experiment_server import ExperimentServer
from hasel_driver.nodes.middleware import middleware_threads, prepare, reach
from hasel_driver.nodes.other_drivers import Claim
from hasel_driver.nodes.parameters import check_files, declare, values
from hasel_driver.nodes.supply_history import SupplyHistory
from hasel_driver.nodes.surroundings import ALIVE_PERIOD_S, STEADY, HostSurroundings, UrgentInputs
from hasel_driver.protocol.faults import (
    DriverError,
    Fault,
    FaultCode,
    PortInUseError,
    PortMissingError,
    RefusedError,
)
from hasel_driver.safety.supervisor import COMMAND_TIMEOUT_S
from hasel_driver.safety.supply_link import Snapshot, SupplyLink
from hasel_driver.safety.supply_thread import request_realtime
from hasel_driver.supplies.serial_port import check_not_in_use

THREAD_SWITCH_S = 0.0005  # Python's 5 ms would let the executor hold up commands and stops
RETRY_PERIOD_S = 2.0  # between attempts to open a port that could not be opened at the start
REFUSED_LOG_S = 2.0
LAST_STATE_S = 0.2  # for which the end waits until the last state has been heard


class DriverNode(LifecycleNode):
    """Unconfigured: port closed. Inactive: telemetry. Active: may be armed, by the service `arm` only."""

    def __init__(self, **options: Any) -> None:
        super().__init__("hasel_driver", **{"namespace": NAMESPACE, **options})
        self._link: SupplyLink | None = None
        self._lifecycle_active = False
        self._changing = threading.Lock()  # held while the state on which arming depends changes
        self._retrying = self._port_missing = False
        self._last_problem = ""
        self._silent = False  # the supply, at rest
        self._note = ""  # why it disarmed itself
        self._configured_s = 0.0
        self._claim = Claim(time.monotonic)
        self._refused_s: dict[str, float] = {}  # when it was last said, by the other commander's name
        self._command_age_s = math.nan  # of the last command, by its stamp
        self.end_reason: str | None = None  # why the process must end
        check_files(self.get_name(), self.get_fully_qualified_name(), sys.argv)
        declare(self, lambda: self._link is not None, self._lower_maximum)
        # Before anything of this node answers to the names of the other.
        check_not_in_use(values(self)["port"])
        slow = ReentrantCallbackGroup()
        self._state = publisher(self, SupplyState, STATE, Role.SAMPLES)
        self._frame_id = frame_of(self, "supply")
        self._diagnostics = Diagnostics(self, Part.SUPPLY)
        self.history = SupplyHistory(values(self)["history_file"], self.get_logger().warning)
        self._inputs = UrgentInputs(
            self.get_namespace(),
            lambda: [self.resolve_service_name(name) for name in SERVICES],
            self._on_command,
            self._on_stop_topic,
            self._on_inputs_alive,
            values(self)["realtime_priority"],
        )
        self._surroundings = HostSurroundings(self._inputs)
        self._trigger_services = DriverServices(
            self,
            slow,
            lambda: self._link,
            self._changing,
            self._check_arming,
            self._surroundings,
            self._claim,
        )
        alone = MutuallyExclusiveCallbackGroup
        self.create_timer(ALIVE_PERIOD_S, self._on_heartbeat, callback_group=alone(), clock=STEADY)
        self.create_timer(1.0, self._on_diagnostics, callback_group=slow, clock=STEADY)
        self.create_timer(RETRY_PERIOD_S, self._retry, callback_group=alone(), clock=STEADY)
        self.experiments = ExperimentServer(self, lambda: self._link, slow)

    # Lifecycle

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Open the port and prove the board; disarmed."""
        chosen = values(self)
        try:
            link = SupplyLink(chosen, self._take)
        except PortInUseError as error:
            self.end_reason = str(error)
            rclpy.try_shutdown()
            return TransitionCallbackReturn.FAILURE
        except Exception as error:  # noqa: BLE001  rclpy would swallow it, and the node end without a word
            problem = f"A defect kept the driver from starting, please report it: {error!r}."
            problem = str(error) if isinstance(error, DriverError) else problem
            self._port_missing = isinstance(error, PortMissingError)
            if not (self._port_missing and problem == self._last_problem):  # once, not with every attempt
                self.get_logger().error(problem)
            self._last_problem = problem
            return TransitionCallbackReturn.FAILURE
        self._last_problem = ""
        self._link = link
        self._say_priority(chosen["realtime_priority"], link.now.without_realtime)
        if self._inputs.holders:
            self.fail(Fault(FaultCode.EMERGENCY_STOP, "by topic, before the port was opened"))
        self._configured_s = time.monotonic()
        self.experiments.watch_topics(chosen["recorded_topics"])
        self.get_logger().info(f"{link.now.name} on {chosen['port']}, disarmed; commanded by {reach()}.")
        return TransitionCallbackReturn.SUCCESS

    def _say_priority(self, priority: int, problem: str | None) -> None:
        for thread in middleware_threads():
            request_realtime(priority, thread)
        if problem is None:
            self.get_logger().info(f"Commands are sent with real-time priority {priority}.")
        else:
            self.get_logger().info(f"Commands are sent without real-time priority ({problem}).")

    def begin(self) -> None:
        """Configure and activate; a port that is not there is waited for, anything else that is wrong ends the node."""
        self._port_missing = False
        if self.trigger_configure() == TransitionCallbackReturn.SUCCESS:
            self._retrying = False
            self.trigger_activate()
        elif self._port_missing:
            self._retrying = True
        elif self.end_reason is None:
            self.end_reason = self._last_problem
            rclpy.try_shutdown()

    def _retry(self) -> None:
        if self._retrying and self._link is None and self.end_reason is None:
            self.begin()

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Allow arming."""
        self._lifecycle_active = True
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Disarm; without proof of it, FAULT."""
        with self._changing:
            self._lifecycle_active = False
        if self._link is not None:
            try:
                self._trigger_services.disarm()
            except DriverError as error:
                self.get_logger().error(str(error))
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Disarm and close the port; the node may be configured again."""
        self.close()
        return TransitionCallbackReturn.SUCCESS

    on_shutdown = on_error = on_cleanup

    def close(self) -> None:
        """Disarm, publish what became of it, and close the port, from whatever state."""
        with self._changing:
            self._lifecycle_active = self._retrying = False
            link, self._link = self._link, None
        if link is not None:
            link.stop()
            with quiet_at_shutdown():
                self._state.wait_for_all_acked(Duration(seconds=LAST_STATE_S))

    def leave(self) -> None:
        """Stop listening."""
        self._inputs.close()
        self.history.close()

    # Topics

    def _on_command(self, publisher: bytes, name: str, voltage_v: tuple[float, ...], age_s: float) -> None:
        link = self._link
        if link is None or not self._lifecycle_active:
            return
        obeyed, new = self._claim.take(publisher, name) if link.now.armed else (True, False)
        if not obeyed:
            self._say_refused(
                name, f"are refused: {self._claim.holder} holds the claim. End that one, or arm anew."
            )
            return
        self._command_age_s = age_s
        if not abs(age_s) < COMMAND_TIMEOUT_S:
            when = f"{age_s:.2f} s ago" if age_s > 0 else f"in {-age_s:.2f} s"
            self._say_refused(
                name,
                f"are ignored: by their stamps they were made {when}, {COMMAND_TIMEOUT_S} s is the most. "
                "Synchronise the clocks of the two machines (chrony, NTP), or look for what holds the network up.",
            )
        if new:
            link.tell("await_zero")
        link.tell("command", voltage_v, time.monotonic() - age_s)

    def _say_refused(self, name: str, why: str) -> None:
        if time.monotonic() - self._refused_s.get(name, -math.inf) > REFUSED_LOG_S:
            self._refused_s[name] = time.monotonic()
            self.get_logger().warning(f"Commands of {name} {why}")

    def _on_stop_topic(self, asserted: bool, who: str) -> None:
        if asserted:
            self.fail(Fault(FaultCode.EMERGENCY_STOP, f"by topic, from {who}"))

    def _on_inputs_alive(self) -> None:
        link = self._link
        if link is not None:
            link.tell("host_is_alive", "inputs")

    def _take(self, now: Snapshot) -> None:
        inputs, status = self._inputs, now.status
        with quiet_at_shutdown():
            holders = inputs.holders.names(inputs.stop_topic.present()) if inputs.holders else []
            commander = self._claim.holder if now.armed else ""
            message = to_supply_state(status, now.limits, holders, self._frame_id, commander)
            self._state.publish(message)
            self.experiments.record_state(message)
        self.history.take(status)
        if status.note != self._note:
            self._note = status.note
            if status.note:
                self.get_logger().warning(sentence(status.note))
        if bool(status.silent_s) != self._silent:
            self._silent = not self._silent
            self.get_logger().warning(
                "The supply does not report: its state is unknown, and it cannot be armed."
                if self._silent
                else "The supply reports again."
            )

    def _lower_maximum(self, voltage_v: float) -> None:
        link = self._link
        if link is not None:
            link.ask("lower_maximum", voltage_v)

    def _on_heartbeat(self) -> None:
        link = self._link
        if link is None:
            return
        if not link.is_alive():
            self._take(link.now)
        link.tell("host_is_alive", "services")
        if not link.now.armed:
            self._surroundings.calm()
        elif (threat := self._surroundings.threat()) is not None:
            self.fail(threat)

    def _on_diagnostics(self) -> None:
        link, inputs = self._link, self._inputs
        holders = inputs.holders.names(inputs.stop_topic.present())
        now = link.now if link is not None else None
        details: dict[str, object] = {"emergency_stop_held_by": ", ".join(holders) or "nobody"}
        details |= self.history.summary()
        if link is not None and now is not None:
            details |= {
                "device": now.name,
                "maximum_voltage_v": now.limits.maximum_voltage_v,
                "rejected_commands": now.rejected_commands,
                "command_age_s": self._command_age_s,
                "garbled_lines": now.garbled_lines,
                "interlock_closed": now.status.interlock_closed,
                "grounds_itself_without_host": now.capabilities.deadman,
                "safety_process_alive": link.is_alive(),
            }
        level, sentence, known = supply_health(now.status if now else None)
        self._diagnostics.tell(level, sentence, known | details, str(details.get("device", "")))

    # What the services ask for

    def _check_arming(self) -> None:
        link = self._link
        if not self._lifecycle_active or link is None:
            raise RefusedError("The node is not active: activate it (lifecycle) first.")
        self._surroundings.check_arming()
        waited_s = time.monotonic() - self._configured_s
        discovery_s = self.get_parameter("discovery_time").value
        if waited_s < discovery_s:
            raise RefusedError(
                "An emergency stop sent before may still arrive:"
                f" wait {discovery_s - waited_s:.1f} s and arm again."
            )
        if not link.now.capabilities.deadman and not self.get_parameter("accept_no_deadman").value:
            raise RefusedError(
                "This supply stays live when its host dies:"
                " set the parameter accept_no_deadman if that is acceptable."
            )

    # Faults

    def fail(self, fault: Fault) -> None:
        """Ground the output and latch `fault`."""
        link = self._link
        if link is not None:
            link.tell("fail", fault)
            self.get_logger().error(f"{fault}: grounding the output.")

    def report_illegal_transition(self, error: Exception) -> None:
        """Rclpy lets an illegal transition escape from spin: ground what is armed, and live on."""
        self.get_logger().error(f"Illegal lifecycle transition, ignored: {error}")
        link = self._link
        if link is not None and link.now.armed:
            self.fail(Fault(FaultCode.ILLEGAL_TRANSITION))


def catch_signals() -> int:
    """From here on Ctrl-C and a service manager's stop do nothing but write to the descriptor returned."""
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    signal.set_wakeup_fd(writer, warn_on_full_buffer=False)
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: None)
    return reader


def end_at_signal(node: DriverNode, signals: int) -> None:
    """Wait for a signal; then ground, tell, and end, whatever the other threads do."""
    os.read(signals, 1)
    node.close()
    rclpy.try_shutdown()


def main() -> int:
    """Spin until shut down; the supply is disarmed on the way out."""
    sys.setswitchinterval(THREAD_SWITCH_S)
    prepare()
    signals = catch_signals()
    end_at_once_with_parent()
    try:
        rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
        node = DriverNode()
    except (DriverError, ParameterException, OSError, RCLError, RCLInvalidROSArgsError) as error:
        print(f"hasel_driver: {' '.join(str(error).split())}", file=sys.stderr)
        rclpy.try_shutdown()
        return 1
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    threading.Thread(target=end_at_signal, args=(node, signals), name="signals", daemon=True).start()
    try:
        with quiet_at_shutdown():
            if node.get_parameter("autostart").value:
                node.begin()
            spin(executor, node.report_illegal_transition)
    finally:
        node.close()
        node.leave()
        executor.shutdown()
        rclpy.try_shutdown()
    if node.end_reason is not None:
        print(f"hasel_driver: {node.end_reason}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
