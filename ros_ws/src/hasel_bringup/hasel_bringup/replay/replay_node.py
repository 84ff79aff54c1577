"""Publishes a recording's states and measured angles."""

import math
import time
from collections.abc import Sequence

from builtin_interfaces.msg import Time
from hasel_common.endpoints import Role, frame_of, publisher
from hasel_common.topics import MEASURED, NAMESPACE, STATE
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_recording.drive_channel import HASEL_PAIR
from rclpy.duration import Duration
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Header

from hasel_bringup.errors import BringupError
from hasel_bringup.replay.clock import ReplayClock
from hasel_bringup.replay.timeline import ReplayedFrame

_SETTLED_S = 1.0
_MUSCLES = [channel.name for channel in HASEL_PAIR]
_UNKNOWN_PAIR = [math.nan] * 2


class ReplayNode(Node):
    """Nothing is lost: subscribers are waited for, messages are kept until they are acknowledged.

    clock: publish each frame's stamp on /clock too, for nodes with `use_sim_time`.
    """

    def __init__(self, clock: bool = False) -> None:
        super().__init__("hasel_replay", namespace=NAMESPACE)
        self._states = publisher(self, SupplyState, STATE, Role.EVERY_SAMPLE)
        self._angles = publisher(self, BendingAngle, MEASURED, Role.EVERY_SAMPLE)
        self._clock = publisher(self, Clock, "/clock", Role.CLOCK) if clock else None

    def wait_for_subscribers(self, expected: Sequence[str], seconds: float) -> None:
        """Wait until every expected node hears the states and all known subscribers are connected.

        Without names, wait for anybody and then until nobody came for a second. Raises BringupError after `seconds`.
        """
        end, counts, since = time.monotonic() + seconds, (0, 0), time.monotonic()
        while time.monotonic() < end:
            time.sleep(0.02)
            now = tuple(p.get_subscription_count() for p in (self._states, self._angles))
            if now != counts:
                counts, since = now, time.monotonic()
            if expected and self._hear(expected):
                return
            if not expected and counts[0] and time.monotonic() - since > _SETTLED_S:
                return
        missing = f"{', '.join(expected)} did not subscribe" if expected else "nobody subscribed"
        raise BringupError(
            f"{missing} to {self._states.topic_name} within {seconds:g} s; start the simulator "
            "(ros2 run hasel_sim simulator) in the same ROS_DOMAIN_ID, or wait longer with --wait"
        )

    def _hear(self, expected: Sequence[str]) -> bool:
        for sent in (self._states, self._angles):
            known = [info.node_name for info in self.get_subscriptions_info_by_topic(sent.topic_name)]
            if sent.get_subscription_count() < len(known):
                return False
            if sent is self._states and not set(expected) <= set(known):
                return False
        return True

    def replay(self, frames: Sequence[ReplayedFrame], rate: float, on_frame=lambda: None) -> None:
        """Publish one recording at `rate` times real time (infinite: as fast as it is taken)."""
        clock = ReplayClock(rate)
        clock.start(frames[0].stamp_ns)
        for frame in frames:
            clock.wait_for(frame.stamp_ns)
            self._publish(frame)
            on_frame()

    def finish(self, seconds: float = 10.0) -> None:
        """Wait until every message has arrived. Raises BringupError when one has not."""
        for sent in (self._states, self._angles):
            if not sent.wait_for_all_acked(Duration(seconds=seconds)):
                raise BringupError(
                    f"not all of {sent.topic_name} arrived within {seconds:g} s; a subscriber is too slow or was "
                    "stopped: replay again with a lower --rate"
                )

    def _publish(self, frame: ReplayedFrame) -> None:
        seconds, nanoseconds = divmod(frame.stamp_ns, 1_000_000_000)
        stamp = Time(sec=seconds, nanosec=nanoseconds)
        if self._clock is not None:
            self._clock.publish(Clock(clock=stamp))
        state = SupplyState(
            header=Header(stamp=stamp, frame_id=frame_of(self, "supply")), mode=SupplyState.ACTIVE
        )
        state.muscle, state.commanded_voltage = _MUSCLES, list(frame.voltage)
        state.measured_voltage = state.current = _UNKNOWN_PAIR
        self._states.publish(state)
        if frame.sin_theta is None:
            return
        header = Header(stamp=stamp, frame_id=frame_of(self, "camera"))
        angle = BendingAngle(header=header, sin_theta=frame.sin_theta, valid=math.isfinite(frame.sin_theta))
        angle.theta = math.asin(max(-1.0, min(1.0, frame.sin_theta))) if angle.valid else math.nan
        angle.sin_theta_standard_deviation = math.nan
        self._angles.publish(angle)
