"""`ros2 run hasel_driver driver_node`: lifecycle node on top of the supply's thread."""

import sys
import time
from concurrent.futures import Future
from functools import partial

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from hasel_interfaces.msg import SupplyState
from rclpy._rclpy_pybind11 import RCLError
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from std_srvs.srv import Trigger

from hasel_driver.backends import make_supply
from hasel_driver.errors import DriverError, RefusedError
from hasel_driver.experiment_server import ExperimentServer
from hasel_driver.faults import Fault, FaultCode
from hasel_driver.limits import Voltages
from hasel_driver.messages import to_diagnostics, to_supply_state
from hasel_driver.mode import Mode
from hasel_driver.node_parameters import declare, values
from hasel_driver.supervisor import Status, Supervisor
from hasel_driver.supply_thread import SupplyThread
from hasel_driver.urgent_inputs import ALIVE_PERIOD_S, UrgentInputs

PROOF_TIMEOUT_S = 0.4
THREAD_SWITCH_S = 0.0005  # Python's 5 ms would let the executor hold up the supply's thread


class DriverNode(LifecycleNode):
    """Unconfigured: port closed. Inactive: telemetry. Active: may be armed, by the service `arm` only."""

    def __init__(self, **options) -> None:
        super().__init__("hasel_driver", **options)
        declare(self, lambda: self._thread is not None)
        self._thread: SupplyThread | None = None
        self._lifecycle_active = False
        self._stop_asserted = False
        self._configured_s = 0.0
        slow = ReentrantCallbackGroup()
        self._state = self.create_publisher(SupplyState, "/hasel/state", 50)
        self._diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 10)
        for name in ("arm", "disarm", "emergency_stop", "clear_fault"):
            handler = partial(self._serve, getattr(self, f"_{name}"))
            self.create_service(Trigger, f"/hasel/{name}", handler, callback_group=slow)
        self.create_timer(ALIVE_PERIOD_S, self._on_heartbeat, callback_group=MutuallyExclusiveCallbackGroup())
        self.create_timer(1.0, self._on_diagnostics, callback_group=slow)
        self.experiments = ExperimentServer(self, lambda: self._thread, slow)
        self._inputs = UrgentInputs(self._on_command, self._on_stop_topic, self._on_inputs_alive)

    # Lifecycle

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Open the port and prove the board; disarmed."""
        chosen = values(self)
        try:
            supply = make_supply(chosen)
            supervisor = Supervisor(supply, time.monotonic)
            supervisor.connect()
        except DriverError as error:
            self.get_logger().error(str(error))
            return TransitionCallbackReturn.FAILURE
        self._thread = SupplyThread(supervisor, supply, self._publish, self.experiments.step)
        self._thread.start()
        if self._stop_asserted:
            self.fail(Fault(FaultCode.EMERGENCY_STOP, "by topic, before the port was opened"))
        self._configured_s = time.monotonic()
        self.experiments.watch_topics(chosen["recorded_topics"])
        self.get_logger().info(f"{supervisor.name} on {chosen['port']}, disarmed.")
        return TransitionCallbackReturn.SUCCESS

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Allow arming."""
        self._lifecycle_active = True
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Disarm; without proof of it, FAULT."""
        self._lifecycle_active = False
        if self._thread is not None:
            try:
                self._disarm()
            except DriverError as error:
                self.get_logger().error(str(error))
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Disarm and close the port."""
        self.close()
        return TransitionCallbackReturn.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Disarm and close the port."""
        self.close()
        return TransitionCallbackReturn.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Disarm and close the port; the node may be configured again."""
        self.close()
        return TransitionCallbackReturn.SUCCESS

    def close(self) -> None:
        """Disarm and close the port, from whatever state."""
        self._lifecycle_active = False
        thread, self._thread = self._thread, None
        if thread is not None:
            thread.stop()

    def leave(self) -> None:
        """Stop listening."""
        self._inputs.close()

    # Topics

    def _on_command(self, voltage_v: Voltages, age_s: float) -> None:
        thread = self._thread
        if thread is not None and self._lifecycle_active:
            thread.call(lambda: thread.supervisor.command(voltage_v, age_s))

    def _on_stop_topic(self, asserted: bool) -> None:
        self._stop_asserted = asserted
        if asserted:
            self.fail(Fault(FaultCode.EMERGENCY_STOP, "by topic"))

    def _on_inputs_alive(self) -> None:
        thread = self._thread
        if thread is not None:
            thread.host_is_alive("inputs")

    def _publish(self, status: Status) -> None:
        message = to_supply_state(status)
        self._state.publish(message)
        self.experiments.record_state(message)

    def _on_heartbeat(self) -> None:
        thread = self._thread
        if thread is None:
            return
        thread.host_is_alive("services")
        masters = self.count_publishers("/hasel/command")
        if masters > 1 and thread.supervisor.armed:
            self.fail(Fault(FaultCode.TWO_MASTERS, f"{masters} publishers of /hasel/command"))

    def _on_diagnostics(self) -> None:
        thread = self._thread
        status, details = None, {"emergency_stop_topic": self._stop_asserted}
        if thread is not None:
            supervisor = thread.supervisor
            status = supervisor.status()
            details |= {
                "device": supervisor.name,
                "maximum_voltage_v": supervisor.maximum_voltage_v,
                "rejected_commands": supervisor.rejected_commands,
                "grounds_itself_without_host": supervisor.capabilities.deadman,
                "thread_alive": thread.is_alive(),
            }
        self._diagnostics.publish(to_diagnostics(status, self.get_clock().now().to_msg(), details))

    # Services

    def _serve(self, action, request: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
        try:
            response.message = action()
            response.success = True
        except DriverError as error:
            response.message = str(error)
            self.get_logger().warning(response.message)
        return response

    def _arm(self) -> str:
        thread = self._require_thread()
        if not self._lifecycle_active:
            raise RefusedError("The node is not active: activate it (lifecycle) first.")
        if self._stop_asserted:
            raise RefusedError("The emergency stop topic says true: publish false, then clear the fault.")
        waited_s = time.monotonic() - self._configured_s
        discovery_s = self.get_parameter("discovery_time").value
        if waited_s < discovery_s:
            raise RefusedError(
                "An emergency stop sent before may still arrive:"
                f" wait {discovery_s - waited_s:.1f} s and arm again."
            )
        if self.count_publishers("/hasel/command") > 1:
            raise RefusedError("More than one node publishes /hasel/command: stop all but one, then arm.")
        supervisor = thread.supervisor
        if not supervisor.capabilities.deadman and not self.get_parameter("accept_no_deadman").value:
            raise RefusedError(
                "This supply stays live when its host dies:"
                " set the parameter accept_no_deadman if that is acceptable."
            )
        _result(thread.call(supervisor.arm))
        armed = thread.expect(
            lambda: supervisor.status().mode is Mode.ARMED or not supervisor.armed, PROOF_TIMEOUT_S
        )
        if not _result(armed) or not supervisor.armed:
            thread.call(supervisor.disarm)
            raise RefusedError(f"The supply did not arm: {supervisor.refusal or supervisor.status()}.")
        self.get_logger().warning("Armed: high voltage may be on the output from now on.")
        return "Armed, 0 V."

    def _disarm(self) -> str:
        thread = self._require_thread()
        _result(thread.call(thread.supervisor.disarm))
        return self._prove_grounded(thread, "Disarmed")

    def _emergency_stop(self) -> str:
        self.fail(Fault(FaultCode.EMERGENCY_STOP, "by service"))
        return self._prove_grounded(self._require_thread(), "Stopped")

    def _clear_fault(self) -> str:
        thread = self._require_thread()
        if self._stop_asserted:
            raise RefusedError("The emergency stop topic still says true: publish false first.")
        supervisor = thread.supervisor
        _result(thread.expect(lambda: supervisor.status().grounded is not False, PROOF_TIMEOUT_S))
        _result(thread.call(supervisor.clear_fault))
        return "Cleared: STANDBY, disarmed."

    def fail(self, fault: Fault) -> None:
        """Ground the output and latch `fault`."""
        thread = self._thread
        if thread is not None:
            self.get_logger().error(f"{fault}: grounding the output.")
            thread.call(lambda: thread.supervisor.fail(fault))

    def _prove_grounded(self, thread: SupplyThread, done: str) -> str:
        supervisor = thread.supervisor

        def off() -> bool:
            status = supervisor.status()
            return status.grounded is True and not status.mode.may_be_live

        if _result(thread.expect(off, PROOF_TIMEOUT_S)):
            return f"{done}: the supply reports its output grounded. Stored charge needs its bleeder's time."
        if not supervisor.capabilities.proves_grounded and supervisor.connected:
            return f"{done}: the supply was switched off, but this kind cannot prove its output grounded."
        raise RefusedError(f"{done}, but NOT proven: {supervisor.status()}. Treat the output as live.")

    def _require_thread(self) -> SupplyThread:
        thread = self._thread
        if thread is None:
            raise RefusedError("The port is closed: configure the node (lifecycle) first.")
        if not thread.is_alive():
            raise RefusedError(
                "The supply's thread has ended; the board has grounded itself: clean up and configure."
            )
        return thread

    def report_illegal_transition(self, error: Exception) -> None:
        """Rclpy lets an illegal transition escape from spin: ground what is armed, and live on."""
        self.get_logger().error(f"Illegal lifecycle transition, ignored: {error}")
        thread = self._thread
        if thread is not None and thread.supervisor.armed:
            self.fail(Fault(FaultCode.ILLEGAL_TRANSITION))


def _result(future: Future):
    return future.result(timeout=10.0)


def main() -> None:
    """Spin until shut down; the supply is disarmed on the way out."""
    sys.setswitchinterval(THREAD_SWITCH_S)
    rclpy.init()
    node = DriverNode()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    if node.get_parameter("autostart").value:
        node.trigger_configure() == TransitionCallbackReturn.SUCCESS and node.trigger_activate()
    try:
        while rclpy.ok():
            try:
                executor.spin()
            except RCLError as error:
                node.report_illegal_transition(error)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.close()
        node.leave()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
