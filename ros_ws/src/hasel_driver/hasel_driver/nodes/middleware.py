# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The ROS middleware below rclpy: what it may hear and hold up, and who published a message.

Over shared memory Fast DDS may wait 333 ms when another node comes (Fast-DDS issue 6535), and rclpy lets no other
thread run meanwhile: longer than the board's heartbeat timeout. So the driver's process talks over UDP. And what is on
the network may command what it discovers: only this machine is discovered unless the user says otherwise.

rclpy gives no publisher's identifier with a message, so `rcl_take_serialized_message` of ROS 2's own C library is
called for it; its structures are those of ROS 2 Jazzy (rmw/types.h, rcutils/types/uint8_array.h).
"""

import ctypes
import os
from collections.abc import Callable, MutableMapping
from pathlib import Path
from typing import Any

from rclpy._rclpy_pybind11 import Subscription, WaitSet
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from rclpy.topic_endpoint_info import TopicEndpointInfo
from rclpy.type_support import check_is_valid_msg_type
from rclpy.utilities import get_rmw_implementation_identifier
from rclpy.waitable import NumberOfEntities, Waitable

RANGE, PROFILES = "ROS_AUTOMATIC_DISCOVERY_RANGE", "FASTRTPS_DEFAULT_PROFILES_FILE"
LOCALHOST_ONLY = "ROS_LOCALHOST_ONLY"  # older, and goes before the range
PEERS = "ROS_STATIC_PEERS"
LOOPBACK = Path(__file__).with_name("loopback.xml")
THREAD_PREFIX = "dds."  # of the names of Fast DDS's threads
UNNAMED = "a node whose name is not known yet"
_NOT_KNOWN_YET = "_NODE_NAME_UNKNOWN_"
IDENTIFIER_BYTES = 16
_OK = 0  # RCL_RET_OK
_rcl, _rcutils = ctypes.CDLL("librcl.so"), ctypes.CDLL("librcutils.so")


def prepare(environment: MutableMapping[str, str] = os.environ) -> None:
    """To be called before `rclpy.init`; a user's own range, peers, profiles or transports stay, unless empty."""
    if not any(environment.get(name, "").strip() for name in (RANGE, LOCALHOST_ONLY, PEERS)):
        environment[RANGE] = "LOCALHOST"
    if "fastrtps" not in get_rmw_implementation_identifier() or PROFILES in environment:
        return
    if _this_machine_only(environment) and LOOPBACK.is_file():
        # There rmw_fastrtps insists on shared memory: give Fast DDS the same range in its own words.
        environment.pop(LOCALHOST_ONLY, None)
        environment.update({RANGE: "SYSTEM_DEFAULT", PROFILES: str(LOOPBACK)})
    else:
        environment.setdefault("FASTDDS_BUILTIN_TRANSPORTS", "UDPv4")


def reach(environment: MutableMapping[str, str] = os.environ) -> str:
    """Who can command, in words."""
    if _this_machine_only(environment) or environment.get(PROFILES) == str(LOOPBACK):
        return "this machine only"
    return "EVERY machine that discovers this one: see docs/how_to/network.md"


def _this_machine_only(environment: MutableMapping[str, str]) -> bool:
    only = environment.get(LOCALHOST_ONLY, "").strip().lower()
    if only:
        return only in ("1", "true")
    chosen = environment.get(RANGE, "").strip().upper()
    return chosen == "OFF" or (chosen == "LOCALHOST" and not environment.get(PEERS))


def middleware_threads() -> list[int]:
    """The threads of this process in which Fast DDS receives what others publish; none where that is not known."""
    names = {int(task.parent.name): task.read_text() for task in Path("/proc/self/task").glob("*/comm")}
    return [thread for thread, name in names.items() if name.startswith(THREAD_PREFIX)]


def full_name(info: TopicEndpointInfo) -> str:
    """With its namespace."""
    if info.node_name == _NOT_KNOWN_YET:
        return UNNAMED
    return f"{info.node_namespace.rstrip('/')}/{info.node_name}"


def publishers_of(node: Node, topic: str) -> dict[bytes, str]:
    """The nodes that publish a topic, by the identifier of their publisher."""
    publishers = node.get_publishers_info_by_topic(topic)
    return {bytes(info.endpoint_gid[:IDENTIFIER_BYTES]): full_name(info) for info in publishers}


class _Identifier(ctypes.Structure):
    _fields_ = [("implementation", ctypes.c_char_p), ("data", ctypes.c_uint8 * IDENTIFIER_BYTES)]


class _MessageInfo(ctypes.Structure):
    _fields_ = [
        ("source_timestamp", ctypes.c_int64),
        ("received_timestamp", ctypes.c_int64),
        ("publication_sequence_number", ctypes.c_uint64),
        ("reception_sequence_number", ctypes.c_uint64),
        ("publisher", _Identifier),
        ("from_intra_process", ctypes.c_bool),
    ]


class _Allocator(ctypes.Structure):
    _fields_ = [(name, ctypes.c_void_p) for name in ("allocate", "free", "grow", "zero_allocate", "state")]


class _Bytes(ctypes.Structure):
    _fields_ = [
        ("buffer", ctypes.c_void_p),
        ("length", ctypes.c_size_t),
        ("capacity", ctypes.c_size_t),
        ("allocator", _Allocator),
    ]


_rcutils.rcutils_get_default_allocator.restype = _Allocator
_rcutils.rcutils_uint8_array_init.argtypes = [
    ctypes.POINTER(_Bytes),
    ctypes.c_size_t,
    ctypes.POINTER(_Allocator),
]
_rcl.rcl_take_serialized_message.argtypes = [
    ctypes.c_void_p,
    ctypes.POINTER(_Bytes),
    ctypes.POINTER(_MessageInfo),
    ctypes.c_void_p,
]


class IdentifiedSubscription(Waitable):
    """Calls `on_message(publisher, sequence number, message)` in the node's executor; raw: the message as bytes."""

    def __init__(
        self,
        node: Node,
        kind: type,
        topic: str,
        on_message: Callable[[bytes, int, Any], None],
        quality: QoSProfile,
        group: CallbackGroup,
        raw: bool = False,
    ) -> None:
        super().__init__(group)
        self._read: Callable[[bytes], Any] = (
            (lambda data: data) if raw else (lambda data: deserialize_message(data, kind))
        )
        self._on_message = on_message
        check_is_valid_msg_type(kind)  # loads what rcl needs of it
        self._allocator = _rcutils.rcutils_get_default_allocator()
        self._bytes = _Bytes()  # kept, and grown by the middleware
        _rcutils.rcutils_uint8_array_init(ctypes.byref(self._bytes), 256, ctypes.byref(self._allocator))
        with node.handle:
            self._subscription = Subscription(node.handle, kind, topic, quality.get_c_qos_profile())
        self._index: int | None = None
        node.add_waitable(self)

    @property
    def topic_name(self) -> str:
        """The topic's full name, in the node's namespace and remapped."""
        with self._subscription:
            return self._subscription.get_topic_name()

    @property
    def publishers(self) -> int:
        """How many publishers it is connected with."""
        with self._subscription:
            return self._subscription.get_publisher_count()

    def destroy(self) -> None:
        """Let go of the subscription."""
        self._subscription.destroy_when_not_in_use()

    def get_num_entities(self) -> NumberOfEntities:
        """One subscription."""
        return NumberOfEntities(num_subs=1)

    def add_to_wait_set(self, wait_set: WaitSet) -> None:
        """Called by the executor."""
        self._index = wait_set.add_subscription(self._subscription)

    def is_ready(self, wait_set: WaitSet) -> bool:
        """Called by the executor."""
        return wait_set.is_ready("subscription", self._index)

    def take_data(self) -> tuple[bytes, int, bytes] | None:
        """Called by the executor."""
        info = _MessageInfo()
        with self._subscription:
            result = _rcl.rcl_take_serialized_message(
                self._subscription.pointer, ctypes.byref(self._bytes), ctypes.byref(info), None
            )
        if result != _OK:
            return None
        data = ctypes.string_at(self._bytes.buffer, self._bytes.length)
        return bytes(info.publisher.data), info.publication_sequence_number, data

    async def execute(self, taken_data: tuple[bytes, int, bytes] | None) -> None:
        """Called by the executor."""
        if taken_data is not None:
            publisher, sequence, data = taken_data
            self._on_message(publisher, sequence, self._read(data))

    def __enter__(self) -> None:
        self._subscription.__enter__()

    def __exit__(self, *error: object) -> None:
        self._subscription.__exit__(*error)
