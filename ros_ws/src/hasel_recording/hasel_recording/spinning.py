"""Spinning that tells rclpy's illegal transitions from its shutting down."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import rclpy
from rclpy._rclpy_pybind11 import RCLError
from rclpy.executors import Executor, ExternalShutdownException

TRANSITION_WORDS = "lifecycle state machine transition"


@contextmanager
def quiet_at_shutdown() -> Iterator[None]:
    """Whatever rclpy raises because its context was shut down meanwhile is no error."""
    try:
        yield
    except ExternalShutdownException:
        pass
    except RCLError:
        if rclpy.ok():
            raise


def spin(executor: Executor, on_illegal_transition: Callable[[Exception], None]) -> None:
    """Spin until shut down; an illegal lifecycle transition, which escapes from rclpy, is handed on and survived."""
    while rclpy.ok():
        try:
            with quiet_at_shutdown():
                executor.spin()
        except RCLError as error:
            if TRANSITION_WORDS not in str(error):
                raise
            on_illegal_transition(error)
