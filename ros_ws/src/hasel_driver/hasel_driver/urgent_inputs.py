"""Commands and emergency stops on an executor of their own: the main one, with its services, is too slow."""

import threading
import time
from collections.abc import Callable

import rclpy
from hasel_interfaces.msg import Actuation
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Bool

from hasel_driver.limits import Voltages
from hasel_driver.spinning import quiet_at_shutdown

ALIVE_PERIOD_S = 0.05
EVERY = QoSProfile(depth=100, reliability=ReliabilityPolicy.RELIABLE)  # the next must not push out a NaN
EVERY_AND_LAST = QoSProfile(
    depth=100, reliability=ReliabilityPolicy.RELIABLE, durability=DurabilityPolicy.TRANSIENT_LOCAL
)


class UrgentInputs:
    """Calls `on_command(voltage [V], age [s])`, `on_stop(asserted)` and `on_alive()` from a thread of its own."""

    def __init__(
        self,
        on_command: Callable[[Voltages, float], None],
        on_stop: Callable[[bool], None],
        on_alive: Callable[[], None],
    ) -> None:
        self._on_command, self._on_stop = on_command, on_stop
        self._node: Node = rclpy.create_node(
            "hasel_driver_inputs", start_parameter_services=False, enable_rosout=False
        )
        self._node.create_subscription(Actuation, "/hasel/command", self._take_command, EVERY)
        self._node.create_subscription(Bool, "/hasel/emergency_stop", self._take_stop, EVERY_AND_LAST)
        self._node.create_timer(ALIVE_PERIOD_S, on_alive)
        self._executor = SingleThreadedExecutor()
        self._executor.add_node(self._node)
        self._thread = threading.Thread(target=self._spin, name="inputs", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """End the thread."""
        self._executor.shutdown()
        self._thread.join(timeout=2.0)
        self._node.destroy_node()

    def _spin(self) -> None:
        with quiet_at_shutdown():
            self._executor.spin()

    def _take_command(self, command: Actuation) -> None:
        stamp = command.header.stamp
        made_s = stamp.sec + stamp.nanosec * 1e-9
        age_s = time.time() - made_s if made_s else 0.0  # `ros2 topic pub` by hand leaves the stamp empty
        self._on_command((float(command.voltage[0]), float(command.voltage[1])), age_s)

    def _take_stop(self, message: Bool) -> None:
        self._on_stop(message.data)
