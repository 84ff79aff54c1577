"""The process around a node: start, one sentence for what is wrong with its parameters, a quiet end."""

import os
import signal
import sys
from collections.abc import Callable

import rclpy
from hasel_common.command_entry import end_with_parent
from hasel_common.managed_node import quiet_at_shutdown
from rclpy.exceptions import InvalidParameterValueException
from rclpy.node import Node

from hasel_sim.errors import HaselSimError


def run_node(
    make: Callable[[], Node],
    spin: Callable[[Node], None] = rclpy.spin,
    errors: tuple[type[Exception], ...] = (HaselSimError,),
) -> int:
    """Make a node and spin it until it is interrupted or its parent ends; returns the exit code.

    errors: told in one sentence, as a parameter out of range is.
    """
    end_with_parent()
    rclpy.init()
    node = None
    try:
        with quiet_at_shutdown():  # which may come while it is being made, too
            node = make()
            spin(node)
    except (*errors, InvalidParameterValueException) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        pass
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C in a launch file comes twice
        if node is not None:
            node.destroy_node()
        rclpy.try_shutdown()
    return 0


def end_at_once(code: int) -> None:
    """End the process without waiting for a thread that is in the middle of something long.

    Worker processes notice and end too (`parallel.executor`).
    """
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
