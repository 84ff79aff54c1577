"""Commands and emergency stops on an executor of their own: the main one, with its services, is too slow."""

import time
from collections.abc import Callable
from functools import partial

import rclpy
from hasel_interfaces.msg import Actuation
from hasel_recording.endpoints import Role
from hasel_recording.spinning import BackgroundSpin
from hasel_recording.topics import COMMAND, relative
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from hasel_driver.realtime import request_realtime
from hasel_driver.stop_holders import StopHolders
from hasel_driver.stop_topic import StopTopic

ALIVE_PERIOD_S = 0.05
STEADY = Clock(clock_type=ClockType.STEADY_TIME)  # no /clock, and no hand on the system's, may stop a watch


class UrgentInputs:
    """Calls `on_command(voltage [V], age [s])`, `on_stop(asserted, who)` and `on_alive()` from a thread of its own.

    Their quality of service cannot be overridden by parameters: what makes the driver safe is no setting.
    """

    def __init__(
        self,
        namespace: str,
        on_command: Callable[[tuple[float, ...], float], None],
        on_stop: Callable[[bool, str], None],
        on_alive: Callable[[], None],
        realtime_priority: int = 0,
    ) -> None:
        self._on_command = on_command
        self._node: Node = rclpy.create_node(
            "hasel_driver_inputs", namespace=namespace, start_parameter_services=False, enable_rosout=False
        )
        self._commands = self._node.create_subscription(
            Actuation, relative(COMMAND), self._take_command, Role.COMMANDS.value
        )
        self.holders = StopHolders()
        self.stop_topic = StopTopic(self._node, self.holders, on_stop)
        self._node.create_timer(ALIVE_PERIOD_S, on_alive, clock=STEADY)
        # whether the priority was granted, the supply's thread tells
        self._spin = BackgroundSpin(self._node, "inputs", begin=partial(request_realtime, realtime_priority))

    @property
    def command_topic(self) -> str:
        """The full name of the topic of commands."""
        return self._commands.topic_name

    def masters(self) -> int:
        """How many publishers of commands there are."""
        return self._node.count_publishers(self._commands.topic_name)

    def close(self) -> None:
        """End the thread."""
        self._spin.end()
        self.stop_topic.destroy()
        self._spin.close()

    def _take_command(self, command: Actuation) -> None:
        stamp = command.header.stamp
        made_s = stamp.sec + stamp.nanosec * 1e-9
        age_s = time.time() - made_s if made_s else 0.0  # `ros2 topic pub` by hand leaves the stamp empty
        self._on_command(tuple(command.voltage), age_s)
