# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Commands and emergency stops of other nodes, and what those must not do.

On an executor of their own, as the main one, with its services, is too slow.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import rclpy
from hasel_common.endpoints import Role
from hasel_common.managed_node import BackgroundSpin
from hasel_common.topics import COMMAND, relative
from hasel_interfaces.msg import Actuation
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.node import Node

from hasel_driver.nodes.emergency_stop import StopHolders, StopTopic
from hasel_driver.nodes.middleware import UNNAMED, IdentifiedSubscription, publishers_of
from hasel_driver.nodes.other_drivers import NOT_TOLD, Rivals
from hasel_driver.protocol.faults import Fault, FaultCode, RefusedError
from hasel_driver.safety.supply_thread import request_realtime

ALIVE_PERIOD_S = 0.05
STEADY = Clock(clock_type=ClockType.STEADY_TIME)  # no /clock, and no hand on the system's, may stop a watch
DISCOVERY_S = 1.0  # for which a new publisher may be known and not yet connected
NAMING_S = 0.15  # within which another driver's name and host are learnt


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
        found = publishers_of(self._node, self._commands.topic_name)
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
            present = publishers_of(self._node, self._commands.topic_name)
            name = self._names[publisher] = present.get(publisher, UNNAMED)
        stamp = command.header.stamp
        made_s = stamp.sec + stamp.nanosec * 1e-9
        age_s = time.time() - made_s if made_s else 0.0  # `ros2 topic pub` by hand leaves the stamp empty
        self._on_command(publisher, name, tuple(command.voltage), age_s)


@dataclass
class _Lasting:
    """How long something has been true without a break."""

    _since_s: float | None = None

    def for_s(self, true: bool) -> float:
        now_s = time.monotonic()
        self._since_s = (now_s if self._since_s is None else self._since_s) if true else None
        return 0.0 if self._since_s is None else now_s - self._since_s


class HostSurroundings:
    """Asked before arming and clearing, and for a fault while armed."""

    def __init__(self, inputs: UrgentInputs) -> None:
        self.inputs = inputs
        self._unheard, self._rivals = _Lasting(), _Lasting()

    def check_clearing(self) -> None:
        """Raises RefusedError while somebody holds the emergency stop."""
        inputs = self.inputs
        if inputs.holders:
            raise RefusedError(
                f"The emergency stop is held by {', '.join(inputs.holders.names(inputs.stop_topic.present()))}:"
                " publish false there first, or call the service release_emergency_stop."
            )

    def check_arming(self) -> None:
        """Raises RefusedError for what would be a fault, or a doubt, while armed."""
        self.check_clearing()
        inputs = self.inputs
        unheard = inputs.stop_topic.unheard()
        if unheard is not None:
            raise RefusedError(f"An emergency stop might not be heard: {unheard}. Correct that, then arm.")
        rivals = inputs.rivals.found()
        if rivals:
            raise RefusedError(
                f"Another driver answers to the names of this one: {', '.join(rivals)}."
                " End it, or give each a namespace of its own."
            )
        if not inputs.rivals.known:
            raise RefusedError(
                "Whether another driver answers to these names is not known yet: arm again in a moment."
            )
        commanders = inputs.commanders()
        if len(commanders) > 1:
            raise RefusedError(
                f"More than one node publishes {inputs.command_topic}: {', '.join(sorted(commanders.values()))}."
                " End all but one, then arm."
            )

    def threat(self) -> Fault | None:
        """What ends arming now; to be asked often while armed."""
        rivals = self.inputs.rivals.found()
        named = not any(NOT_TOLD in words or UNNAMED in words for words in rivals)
        rival_s = self._rivals.for_s(bool(rivals))
        if rivals and (named or rival_s > NAMING_S):
            return Fault(FaultCode.TWO_DRIVERS, ", ".join(rivals))
        unheard = self.inputs.stop_topic.unheard()
        if self._unheard.for_s(unheard is not None) > DISCOVERY_S:
            return Fault(FaultCode.STOP_NOT_HEARD, unheard or "")
        return None

    def calm(self) -> None:
        """Nothing is armed: what lasts begins anew."""
        self._unheard, self._rivals = _Lasting(), _Lasting()
