"""Commands and emergency stops on an executor of their own: the main one, with its services, is too slow."""

import time
from collections.abc import Callable
from functools import partial

import rclpy
from hasel_common.endpoints import Role
from hasel_common.managed_node import BackgroundSpin
from hasel_common.topics import COMMAND, relative
from hasel_interfaces.msg import Actuation
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from hasel_driver.graph_names import UNNAMED, full_name
from hasel_driver.identified_subscription import IDENTIFIER_BYTES, IdentifiedSubscription
from hasel_driver.realtime import request_realtime
from hasel_driver.rivals import Rivals
from hasel_driver.stop_holders import StopHolders
from hasel_driver.stop_topic import StopTopic

ALIVE_PERIOD_S = 0.05
STEADY = Clock(clock_type=ClockType.STEADY_TIME)  # no /clock, and no hand on the system's, may stop a watch


class UrgentInputs:
    """Calls `on_command(publisher, its node, voltage [V], age [s])`, `on_stop(asserted, who)` and `on_alive()`.

    From a thread of its own, which also watches for other drivers; `services()`: those that nobody else may serve.

    Their quality of service cannot be overridden by parameters: what makes the driver safe is no setting.
    """

    def __init__(
        self,
        namespace: str,
        services: Callable[[], list[str]],
        on_command: Callable[[bytes, str, tuple[float, ...], float], None],
        on_stop: Callable[[bool, str], None],
        on_alive: Callable[[], None],
        realtime_priority: int = 0,
    ) -> None:
        self._on_command = on_command
        self._node: Node = rclpy.create_node(
            "hasel_driver_inputs", namespace=namespace, start_parameter_services=False, enable_rosout=False
        )
        self._commands = IdentifiedSubscription(
            self._node,
            Actuation,
            relative(COMMAND),
            self._take_command,
            Role.COMMANDS.value,
            MutuallyExclusiveCallbackGroup(),
        )
        self.holders = StopHolders()
        self.rivals = Rivals(self._node, services)
        self._names: dict[bytes, str] = {}  # of the nodes that command
        self.stop_topic = StopTopic(self._node, self.holders, on_stop)
        self._node.create_timer(ALIVE_PERIOD_S, on_alive, clock=STEADY)
        # whether the priority was granted, the safety process tells
        self._spin = BackgroundSpin(self._node, "inputs", begin=partial(request_realtime, realtime_priority))

    @property
    def command_topic(self) -> str:
        """The full name of the topic of commands."""
        return self._commands.topic_name

    def commanders(self) -> dict[bytes, str]:
        """The nodes that publish commands, by the identifier of their publisher; a node started anew counts once."""
        publishers = self._node.get_publishers_info_by_topic(self._commands.topic_name)
        found = {bytes(info.endpoint_gid[:IDENTIFIER_BYTES]): full_name(info) for info in publishers}
        latest = {name: identifier for identifier, name in found.items()}
        return {one: name for one, name in found.items() if name == UNNAMED or latest[name] == one}

    def close(self) -> None:
        """End the thread."""
        self._spin.end()
        self.stop_topic.destroy()
        self.rivals.destroy()
        self._commands.destroy()
        self._spin.close()

    def _take_command(self, publisher: bytes, _: int, command: Actuation) -> None:
        name = self._names.get(publisher)
        if name is None or name == UNNAMED:
            name = self._names[publisher] = self._name(publisher)
        stamp = command.header.stamp
        made_s = stamp.sec + stamp.nanosec * 1e-9
        age_s = time.time() - made_s if made_s else 0.0  # `ros2 topic pub` by hand leaves the stamp empty
        self._on_command(publisher, name, tuple(command.voltage), age_s)

    def _name(self, publisher: bytes) -> str:
        for info in self._node.get_publishers_info_by_topic(self._commands.topic_name):
            if bytes(info.endpoint_gid[:IDENTIFIER_BYTES]) == publisher:
                return full_name(info)
        return UNNAMED
