"""`ros2 run hasel_bringup replay RECORDING…`: play recordings onto the topics, for the simulator and sysid to hear."""

import argparse
import sys
from collections.abc import Sequence
from itertools import count

import rclpy
from hasel_common.managed_node import quiet_at_shutdown
from hasel_common.progress import counted
from hasel_recording import RecordingError, read_recordings

from hasel_bringup.errors import BringupError
from hasel_bringup.replay.replay_node import ReplayNode
from hasel_bringup.replay.timeline import one_after_the_other, timeline


def replay(paths: Sequence[str], rate: float, expect: Sequence[str], wait: float, clock: bool) -> None:
    """Play recordings one after the other. Raises RecordingError or BringupError."""
    recordings = read_recordings(paths)
    played = one_after_the_other([timeline(recording) for recording in recordings])
    node = ReplayNode(clock)
    try:
        node.wait_for_subscribers(expect, wait)
        for recording, frames in zip(recordings, played, strict=True):
            numbers = count(1)
            with counted(recording.name, "frames", len(frames)) as done:
                node.replay(frames, rate, lambda done=done, numbers=numbers: done(next(numbers)))
        node.finish()
    finally:
        node.destroy_node()


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code."""
    rclpy.init()
    try:
        with quiet_at_shutdown():
            replay(options.recordings, options.rate, options.expect, options.wait, options.clock)
    except (RecordingError, BringupError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        pass
    finally:
        rclpy.try_shutdown()
    return 0
