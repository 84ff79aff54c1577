"""A subscription to Bool messages that tells who published each: rclpy gives no publisher's identifier with a message.

So `rcl_take` of ROS 2's own C library is called for it; its structures are those of ROS 2 Jazzy (rmw/types.h).
"""

import ctypes
from collections.abc import Callable

from rclpy._rclpy_pybind11 import Subscription
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.qos import QoSProfile
from rclpy.type_support import check_is_valid_msg_type
from rclpy.waitable import NumberOfEntities, Waitable
from std_msgs.msg import Bool

IDENTIFIER_BYTES = 16
_TAKEN = 0  # RCL_RET_OK


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


_rcl = ctypes.CDLL("librcl.so")
_rcl.rcl_take.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.POINTER(_MessageInfo), ctypes.c_void_p]
_rcl.rcl_take.restype = ctypes.c_int


class IdentifiedSubscription(Waitable):
    """Calls `on_message(publisher, sequence number, value)` in the node's executor."""

    def __init__(
        self,
        node: Node,
        topic: str,
        on_message: Callable[[bytes, int, bool], None],
        quality: QoSProfile,
        group: CallbackGroup,
    ) -> None:
        super().__init__(group)
        self._on_message = on_message
        check_is_valid_msg_type(Bool)  # loads what rcl needs of it
        with node.handle:
            self._subscription = Subscription(node.handle, Bool, topic, quality.get_c_qos_profile())
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

    def add_to_wait_set(self, wait_set) -> None:
        """Called by the executor."""
        self._index = wait_set.add_subscription(self._subscription)

    def is_ready(self, wait_set) -> bool:
        """Called by the executor."""
        return wait_set.is_ready("subscription", self._index)

    def take_data(self) -> tuple[bytes, int, bool] | None:
        """Called by the executor."""
        message, info = ctypes.c_bool(), _MessageInfo()
        with self._subscription:
            result = _rcl.rcl_take(
                self._subscription.pointer, ctypes.byref(message), ctypes.byref(info), None
            )
        if result != _TAKEN:
            return None
        return bytes(info.publisher.data), info.publication_sequence_number, message.value

    async def execute(self, taken_data: tuple[bytes, int, bool] | None) -> None:
        """Called by the executor."""
        if taken_data is not None:
            self._on_message(*taken_data)

    def __enter__(self) -> None:
        self._subscription.__enter__()

    def __exit__(self, *error) -> None:
        self._subscription.__exit__(*error)
