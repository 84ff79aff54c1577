# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Who else drives and commands: other drivers that answer to the same names, and the claim of one commander.

Two drivers in one namespace would obey one `arm`, and the first answer to an emergency stop would win.
"""

import os
import socket
import threading
import time
import uuid
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from hasel_common.endpoints import Role
from hasel_common.topics import STATE, relative
from hasel_interfaces.msg import SupplyState
from rclpy._rclpy_pybind11 import NodeNameNonExistentError
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.node import Node
from std_msgs.msg import String

from hasel_driver.nodes.middleware import UNNAMED, IdentifiedSubscription, full_name

DRIVER, PRESENCE = "hasel_driver", "driver_presence"
NOT_TOLD = "on a host that it does not tell"
RIVAL_SILENT_S = 1.0  # a driver that lives has been heard within that time
PARTICIPANT_BYTES = 12  # of an identifier: those that all endpoints of a process share
HOST, PROCESS = slice(2, 4), slice(4, 6)  # in Fast DDS: a hash of the host, half of the process's number
HOLDER_SILENT_S = 0.2  # after which a holder that was started anew has its claim again


class Rivals:
    """Watches from `node`; `services()` are the full names of the services that nobody else may serve."""

    def __init__(self, node: Node, services: Callable[[], list[str]]) -> None:
        self._node, self._services = node, services
        self._name = f"{node.get_namespace().rstrip('/')}/{DRIVER}"
        self.own_words = f"{self._name} on {socket.gethostname()} (process {os.getpid()})"
        self._token = uuid.uuid4().hex
        self._own: bytes | None = None  # this process, as the middleware calls it
        self._words: dict[bytes, str] = {}  # of each process
        self._seen_s: dict[bytes, float] = {}  # when it was heard last, or first known
        group = MutuallyExclusiveCallbackGroup()
        self._subscriptions = [
            IdentifiedSubscription(node, String, PRESENCE, self._take_presence, Role.RESULTS.value, group),
            IdentifiedSubscription(
                node, SupplyState, relative(STATE), self._take_state, Role.SAMPLES.value, group, raw=True
            ),
        ]
        self._presence = node.create_publisher(String, PRESENCE, Role.RESULTS.value)
        self._presence.publish(String(data=f"{self._token} {self.own_words}"))

    @property
    def known(self) -> bool:
        """Whether this driver has found itself, without which it could not tell another."""
        return self._own is not None

    def found(self) -> list[str]:
        """Each other driver in words: its node's name, and its host where it tells that.

        Before this driver has found itself, one that has not told its name may be this one; any more are others.
        """
        infos = self._node.get_publishers_info_by_topic(relative(STATE))
        drivers = {bytes(info.endpoint_gid[:PARTICIPANT_BYTES]): full_name(info) for info in infos}
        unnamed = (each for each in drivers if each not in self._words)
        own = self._own or min(unnamed, key=lambda each: drivers[each] != self._name, default=b"")
        drivers.pop(own, None)
        gone = {each for each in drivers if self._is_gone(each)}
        others = [
            self._words.get(each, f"{name} {NOT_TOLD}") for each, name in drivers.items() if each not in gone
        ]
        servers = max(self._node.count_services(name) for name in self._services())
        if servers > 1 + len(gone) + len(others):
            others.append(self._other_server())
        return others

    def destroy(self) -> None:
        """Stop listening."""
        for subscription in self._subscriptions:
            subscription.destroy()

    def _take_presence(self, publisher: bytes, _: int, message: String) -> None:
        token, _, words = message.data.partition(" ")
        participant = publisher[:PARTICIPANT_BYTES]
        self._words[participant] = words
        if token == self._token:
            self._own = participant

    def _take_state(self, publisher: bytes, *_: object) -> None:
        self._seen_s[publisher[:PARTICIPANT_BYTES]] = time.monotonic()

    def _is_gone(self, participant: bytes) -> bool:
        """Whether the middleware only has not noticed yet that a process of this machine has ended."""
        now_s = time.monotonic()
        if (
            self._own is None
            or participant[HOST] != self._own[HOST]
            or now_s - self._seen_s.setdefault(participant, now_s) < RIVAL_SILENT_S
        ):
            return False
        number = int.from_bytes(participant[PROCESS], "little")
        return not any(int(each.name) & 0xFFFF == number for each in Path("/proc").glob("[0-9]*"))

    def _other_server(self) -> str:
        own = (self._node.get_namespace().rstrip("/") or "/", DRIVER)
        for name, namespace in self._node.get_node_names_and_namespaces():
            if (namespace, name) != own:
                with suppress(NodeNameNonExistentError):
                    served = self._node.get_service_names_and_types_by_node(name, namespace)
                    if {service for service, _ in served} & set(self._services()):
                        return f"{namespace.rstrip('/')}/{name}, which answers to its services"
        return f"{UNNAMED} that answers to its services"


@dataclass
class _Holder:
    publisher: bytes
    name: str
    heard_s: float


class Claim:
    """Publishers are told apart by their identifier in the middleware, a node that comes back by its name.

    For any thread.
    """

    def __init__(self, clock: Callable[[], float]) -> None:
        self._clock, self._lock = clock, threading.Lock()
        self._holder: _Holder | None = None

    @property
    def holder(self) -> str:
        """Its node's name; empty where nobody has it."""
        holder = self._holder
        return holder.name if holder else ""

    def hand_out(self, publishers: Mapping[bytes, str]) -> None:
        """At arming: to the only publisher there is; where there is none, to the first that is heard."""
        with self._lock:
            self._holder = None
            if len(publishers) == 1:
                ((publisher, name),) = publishers.items()
                self._holder = _Holder(publisher, name, self._clock())

    def take(self, publisher: bytes, name: str) -> tuple[bool, bool]:
        """Whether a command of `publisher` is to be obeyed, and whether that is one that was not obeyed before."""
        with self._lock:
            now_s, holder = self._clock(), self._holder
            if holder is not None and holder.publisher == publisher:
                holder.heard_s, holder.name = now_s, name  # which the graph may have told only now
                return True, False
            if holder is None or (
                holder.name == name != UNNAMED and now_s - holder.heard_s > HOLDER_SILENT_S
            ):  # nobody's, or it is back
                self._holder = _Holder(publisher, name, now_s)
                return True, True
            return False, False
