# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_bringup replay RECORDING…`: play recordings onto the topics, for the simulator and sysid to hear."""

import argparse
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import rclpy
from builtin_interfaces.msg import Time
from hasel_common.endpoints import Role, frame_of, publisher
from hasel_common.managed_node import quiet_at_shutdown
from hasel_common.progress import counted
from hasel_common.topics import MEASURED, NAMESPACE, STATE
from hasel_interfaces.msg import BendingAngle, SupplyState
from hasel_recording import Recording, read_recordings
from hasel_recording.drive_channel import HASEL_PAIR
from hasel_recording.recording import held
from rclpy.duration import Duration
from rclpy.node import Node
from rosgraph_msgs.msg import Clock
from std_msgs.msg import Header

from hasel_bringup.errors import BringupError

_PAUSE_S = 10.0
"""Between two recordings; so long that every node takes them for two runs."""
_SETTLED_S = 1.0
_ARRIVAL_S = 10.0
_MUSCLES = [channel.name for channel in HASEL_PAIR]
_UNKNOWN_PAIR = [math.nan] * 2


def run(options: argparse.Namespace) -> int:
    """Play recordings one after the other; returns the exit code. Raises RecordingError or BringupError."""
    rclpy.init()
    try:
        with quiet_at_shutdown():
            _play(options)
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
    return 0


def _play(options: argparse.Namespace) -> None:
    recordings = read_recordings(options.recordings)
    played = one_after_the_other([timeline(recording) for recording in recordings])
    node = ReplayNode(options.clock)
    try:
        node.wait_for_subscribers(options.expect, options.wait)
        for recording, frames in zip(recordings, played, strict=True):
            with counted(recording.name, "frames", len(frames)) as done:
                node.replay(frames, options.rate, done)
        node.finish()
    finally:
        node.destroy_node()


@dataclass(frozen=True)
class ReplayedFrame:
    """voltage [V] (upper, lower) from the stamp [ns] on; sin_theta: None between frames, NaN when not measured."""

    stamp_ns: int
    voltage: tuple[float, float]
    sin_theta: float | None


def timeline(recording: Recording) -> list[ReplayedFrame]:
    """One entry for every frame and every switch of the voltage, in order of time.

    Frames before the header's initial_time_s, which no comparison uses, are left out. Raises BringupError when nothing
    is left, RecordingError for a body that the rig's two voltages do not drive.
    """
    recording.check_hasel_pair()
    drive_time, drive_voltage = recording.recorded_drive()
    start = float(recording.metadata.get("initial_time_s", min(recording.time_s[0], drive_time[0])))
    if start > recording.time_s[-1]:
        raise BringupError(
            f"{recording.name} has no frame at or after initial_time_s = {start:g} s; correct its header"
        )
    times = np.unique(np.concatenate([[start], recording.time_s, drive_time]))
    times = times[times >= start]
    voltage = held(drive_time, drive_voltage, times)
    measured = dict(zip(recording.time_s.tolist(), recording.sin_theta.tolist(), strict=True))
    return [
        ReplayedFrame(round(time * 1e9), tuple(row), measured.get(time))
        for time, row in zip(times.tolist(), voltage.tolist(), strict=True)
    ]


def one_after_the_other(timelines: Sequence[list[ReplayedFrame]]) -> list[list[ReplayedFrame]]:
    """The first as it is, every further one moved to begin well after the one before."""
    placed: list[list[ReplayedFrame]] = []
    for frames in timelines:
        shift = placed[-1][-1].stamp_ns + round(_PAUSE_S * 1e9) - frames[0].stamp_ns if placed else 0
        placed.append([ReplayedFrame(f.stamp_ns + shift, f.voltage, f.sin_theta) for f in frames])
    return placed


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

    def replay(self, frames: Sequence[ReplayedFrame], rate: float, done: Callable[[int], None]) -> None:
        """Publish one recording at `rate` times real time (infinite: as fast as it is taken).

        done: told how many frames are out.
        """
        begun, first_ns = time.monotonic(), frames[0].stamp_ns
        for number, frame in enumerate(frames, start=1):
            due = begun + (frame.stamp_ns - first_ns) * 1e-9 / rate
            time.sleep(max(0.0, due - time.monotonic()))
            self._publish(frame)
            done(number)

    def finish(self) -> None:
        """Wait until every message has arrived. Raises BringupError when one has not."""
        for sent in (self._states, self._angles):
            if not sent.wait_for_all_acked(Duration(seconds=_ARRIVAL_S)):
                raise BringupError(
                    f"not all of {sent.topic_name} arrived within {_ARRIVAL_S:g} s; a subscriber is too slow or was "
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
