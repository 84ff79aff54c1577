# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A node with ROS's lifecycle, and how it and other nodes are spun: with transitions that fail with a sentence."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

import rclpy
from rclpy._rclpy_pybind11 import InvalidHandle, RCLError
from rclpy.context import Context
from rclpy.executors import Executor, ExternalShutdownException, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from hasel_common.node_parameter import AUTOSTART

Return = TransitionCallbackReturn
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
            self._executor.create_task(lambda: setattr(self, "_ending", True))
            self._thread.join(timeout=PATIENCE_S)
        self._executor.shutdown()

    def close(self) -> None:
        """End the thread and leave the graph."""
        self.end()
        self._node.destroy_node()
        if self._owns_context:
            rclpy.try_shutdown(context=self._node.context)

    def _spin(self) -> None:
        if self._begin is not None:
            self._begin()
        with quiet_at_shutdown(self._node.context):
            while not self._ending and self._node.context.ok():
                with suppress(InvalidHandle):  # of a publisher that another thread has just destroyed
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


class ManagedNode(LifecycleNode):
    """Unconfigured: nothing is open. Inactive: ready. Active: at work.

    expected_errors: what `configure` and `activate` may raise; told in a sentence, and the state stays.
    """

    expected_errors: tuple[type[Exception], ...] = ()

    def __init__(self, name: str, **options: Any) -> None:
        super().__init__(name, **options)
        self.active = False
        self._starting = False
        self._problem: Exception | None = None

    def configure(self) -> None:
        """Open what the parameters name."""

    def activate(self) -> None:
        """Begin to work."""

    def deactivate(self) -> None:
        """Stop working, and be ready to begin again; also called when nothing is under way."""

    def cleanup(self) -> None:
        """Close everything; also called when nothing is open."""

    def begin(self) -> None:
        """Configure and activate. Raises what was wrong where that fails."""
        self._starting = True
        try:
            for transition in (self.trigger_configure, self.trigger_activate):
                if transition() != Return.SUCCESS:
                    raise self._problem or RuntimeError(f"{self.get_name()} could not be started")
        finally:
            self._starting = False

    def on_configure(self, state: LifecycleState) -> TransitionCallbackReturn:
        """See `configure`."""
        return self._attempt(self.configure)

    def on_activate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """See `activate`."""
        if self._attempt(self.activate) != Return.SUCCESS:
            return Return.FAILURE
        self.active = True
        return super().on_activate(state)

    def on_deactivate(self, state: LifecycleState) -> TransitionCallbackReturn:
        """See `deactivate`."""
        self.active = False
        self.deactivate()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """See `cleanup`."""
        self.cleanup()
        return Return.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop working and close everything, from whatever state."""
        self.active = False
        self.deactivate()
        self.cleanup()
        return Return.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close everything; the node may be configured again."""
        return self.on_shutdown(state)

    def _attempt(self, work: Callable[[], None]) -> TransitionCallbackReturn:
        try:
            work()
        except self.expected_errors as error:
            self._problem = error
            if not self._starting:
                self.get_logger().error(str(error))
            return Return.FAILURE
        return Return.SUCCESS


def start_and_spin(node: ManagedNode, executor: Executor | None = None) -> None:
    """Begin, unless the parameter `autostart` says otherwise, and spin until shut down (None: in one thread).

    A transition that the lifecycle does not allow is said and ignored.
    """
    if node.get_parameter(AUTOSTART[0]).value:
        node.begin()
    executor = executor or SingleThreadedExecutor()
    executor.add_node(node)
    spin(executor, lambda error: node.get_logger().error(f"Illegal lifecycle transition, ignored: {error}"))
