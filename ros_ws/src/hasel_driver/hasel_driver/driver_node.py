"""`ros2 run hasel_driver driver_node`: lifecycle node on top of the supply's thread."""

import signal
import sys
import time

import rclpy
from diagnostic_msgs.msg import DiagnosticArray
from hasel_interfaces.msg import SupplyState
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn

from hasel_driver.backends import make_supply
from hasel_driver.driver_services import DriverServices
from hasel_driver.errors import DriverError, RefusedError
from hasel_driver.experiment_server import ExperimentServer
from hasel_driver.faults import Fault, FaultCode
from hasel_driver.limits import Voltages
from hasel_driver.messages import to_diagnostics, to_supply_state
from hasel_driver.middleware import avoid_shared_memory
from hasel_driver.node_parameters import declare, values
from hasel_driver.spinning import quiet_at_shutdown, spin
from hasel_driver.status import Status
from hasel_driver.supervisor import Supervisor
from hasel_driver.supply_thread import SupplyThread
from hasel_driver.urgent_inputs import ALIVE_PERIOD_S, UrgentInputs

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
        self._trigger_services = DriverServices(
            self, slow, lambda: self._thread, self._check_arming, self._check_clearing
        )
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
                self._trigger_services.disarm()
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
        with quiet_at_shutdown():
            self._state.publish(message)
        self.experiments.record_state(message)

    def _on_heartbeat(self) -> None:
        thread = self._thread
        if thread is None:
            return
        if not thread.is_alive():
            self._publish(thread.supervisor.status())
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

    # What the services ask for

    def _check_arming(self) -> None:
        thread = self._thread
        if not self._lifecycle_active or thread is None:
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
        if not thread.supervisor.capabilities.deadman and not self.get_parameter("accept_no_deadman").value:
            raise RefusedError(
                "This supply stays live when its host dies:"
                " set the parameter accept_no_deadman if that is acceptable."
            )

    def _check_clearing(self) -> None:
        if self._stop_asserted:
            raise RefusedError("The emergency stop topic still says true: publish false first.")

    # Faults

    def fail(self, fault: Fault) -> None:
        """Ground the output and latch `fault`."""
        thread = self._thread
        if thread is not None:
            self.get_logger().error(f"{fault}: grounding the output.")
            thread.call(lambda: thread.supervisor.fail(fault))

    def report_illegal_transition(self, error: Exception) -> None:
        """Rclpy lets an illegal transition escape from spin: ground what is armed, and live on."""
        self.get_logger().error(f"Illegal lifecycle transition, ignored: {error}")
        thread = self._thread
        if thread is not None and thread.supervisor.armed:
            self.fail(Fault(FaultCode.ILLEGAL_TRANSITION))


def autostart(node: DriverNode) -> None:
    """Configure and activate, as far as it goes."""
    if node.trigger_configure() == TransitionCallbackReturn.SUCCESS:
        node.trigger_activate()


def main() -> None:
    """Spin until shut down; the supply is disarmed on the way out."""
    sys.setswitchinterval(THREAD_SWITCH_S)
    avoid_shared_memory()
    rclpy.init()
    node = DriverNode()
    executor = MultiThreadedExecutor(num_threads=4)
    executor.add_node(node)
    try:
        with quiet_at_shutdown():
            if node.get_parameter("autostart").value:
                autostart(node)
            spin(executor, node.report_illegal_transition)
    except KeyboardInterrupt:
        pass
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in a launch file comes twice
        node.close()
        node.leave()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
