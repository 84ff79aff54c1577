"""`ros2 run hasel_bringup replay RECORDING…`: play recordings onto the topics, for the simulator and sysid to hear."""

import argparse
import math
import sys
from collections.abc import Sequence

import rclpy
from hasel_recording import RecordingError, read_recordings
from rclpy._rclpy_pybind11 import RCLError
from rclpy.executors import ExternalShutdownException
from rclpy.utilities import remove_ros_args
from rich.progress import Progress

from hasel_bringup.errors import BringupError
from hasel_bringup.replay.replay_node import ReplayNode
from hasel_bringup.replay.timeline import one_after_the_other, timeline


def _rate(text: str) -> float:
    if text == "max":
        return math.inf
    try:
        rate = float(text)
    except ValueError:
        rate = 0.0
    if not 0 < rate < math.inf:
        raise argparse.ArgumentTypeError(f"'{text}' is no rate; expected a number above 0 such as 1, or max")
    return rate


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="replay",
        description="Publish state and bending/measured from recordings, with their own stamps, in the namespace "
        "/hasel or another (--ros-args -r __ns:=/rig2); "
        "of further recordings: moved to follow 10 s after the one before.",
    )
    parser.add_argument("recordings", nargs="+", metavar="RECORDING", help=".mcap or .csv file")
    parser.add_argument("--rate", type=_rate, default=1.0, help="times real time, or max (default: 1)")
    parser.add_argument(
        "--expect", nargs="*", default=[], metavar="NODE", help="nodes that must listen first"
    )
    parser.add_argument(
        "--wait", type=float, default=30.0, help="longest wait for listeners [s] (default: 30)"
    )
    parser.add_argument(
        "--clock", action="store_true", help="publish the stamps on /clock, for nodes with use_sim_time"
    )
    return parser


def replay(paths: Sequence[str], rate: float, expect: Sequence[str], wait: float, clock: bool) -> None:
    """Play recordings one after the other. Raises RecordingError or BringupError."""
    recordings = read_recordings(paths)
    played = one_after_the_other([timeline(recording) for recording in recordings])
    node = ReplayNode(clock)
    try:
        node.wait_for_subscribers(expect, wait)
        with Progress() as progress:
            for recording, frames in zip(recordings, played, strict=True):
                task = progress.add_task(recording.name, total=len(frames))
                node.replay(frames, rate, lambda task=task: progress.advance(task))
        node.finish()
    finally:
        node.destroy_node()


def main() -> int:
    """Command line of `replay`; returns the exit code."""
    arguments = _parser().parse_args(remove_ros_args(sys.argv)[1:])
    rclpy.init()
    try:
        replay(arguments.recordings, arguments.rate, arguments.expect, arguments.wait, arguments.clock)
    except (RecordingError, BringupError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    except RCLError:
        if rclpy.ok():  # otherwise it was ended in the middle of a message
            raise
    finally:
        rclpy.try_shutdown()
    return 0


if __name__ == "__main__":
    sys.exit(main())
