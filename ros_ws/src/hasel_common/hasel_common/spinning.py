"""Spinning: of a node in a thread of its own, and one that tells illegal transitions from shutting down."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress

import rclpy
from rclpy._rclpy_pybind11 import InvalidHandle, RCLError
from rclpy.context import Context
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

TRANSITION_WORDS = "lifecycle state machine transition"
PATIENCE_S = 5.0


class BackgroundSpin:
    """Spins a node in a thread of its own, from now on until `end` or `close`.

    begin: called in that thread before anything else; owns_context: the node's context is shut down with it.
    """

    def __init__(
        self, node: Node, name: str, begin: Callable[[], object] | None = None, owns_context: bool = False
    ) -> None:
        self._node, self._begin, self._owns_context = node, begin, owns_context
        self._executor = SingleThreadedExecutor(context=node.context)
        self._executor.add_node(node)
        self._ending = False
        self._thread = threading.Thread(target=self._spin, name=name, daemon=True)
        self._thread.start()

    def end(self) -> None:
        """End the thread, once a callback that runs is over; an executor that is shut down while it spins breaks."""
        if self._thread.is_alive():
            self._executor.create_task(self._end)
            self._thread.join(timeout=PATIENCE_S)
        self._executor.shutdown()

    def close(self) -> None:
        """End the thread and leave the graph."""
        self.end()
        self._node.destroy_node()
        if self._owns_context:
            rclpy.try_shutdown(context=self._node.context)

    def _end(self) -> None:
        self._ending = True

    def _spin(self) -> None:
        if self._begin is not None:
            self._begin()
        with quiet_at_shutdown(self._node.context):
            while not self._ending and self._node.context.ok():
                with suppress(
                    InvalidHandle
                ):  # another thread has just destroyed a publisher: without it, then
                    self._executor.spin_once()


def node_alone(name: str, namespace: str | None = None, domain: int | None = None) -> Node:
    """A node in a context of its own, which leaves signals alone; domain: of ROS, None: the user's."""
    context = Context()
    rclpy.init(context=context, domain_id=domain, signal_handler_options=SignalHandlerOptions.NO)
    return rclpy.create_node(name, namespace=namespace, context=context)


@contextmanager
def quiet_at_shutdown(context: Context | None = None) -> Iterator[None]:
    """Whatever rclpy raises because its context (None: the default) was shut down meanwhile is no error.

    A signal in the middle of a message makes pybind11 raise a plain RuntimeError.
    """
    try:
        yield
    except ExternalShutdownException:
        pass
    except RuntimeError:
        if rclpy.ok(context=context):
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
