"""A node with ROS's lifecycle, whose transitions fail with a sentence."""

from rclpy.executors import Executor, SingleThreadedExecutor
from rclpy.lifecycle import LifecycleNode, LifecycleState, TransitionCallbackReturn

from hasel_common.node_parameter import AUTOSTART
from hasel_common.spinning import spin

Return = TransitionCallbackReturn


class ManagedNode(LifecycleNode):
    """Unconfigured: nothing is open. Inactive: ready. Active: at work.

    expected_errors: what `configure` and `activate` may raise; told in a sentence, and the state stays.
    """

    expected_errors: tuple[type[Exception], ...] = ()

    def __init__(self, name: str, **options) -> None:
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
        self._rest()
        return super().on_deactivate(state)

    def on_cleanup(self, state: LifecycleState) -> TransitionCallbackReturn:
        """See `cleanup`."""
        self.cleanup()
        return Return.SUCCESS

    def on_shutdown(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Stop working and close everything, from whatever state."""
        self._rest()
        self.cleanup()
        return Return.SUCCESS

    def on_error(self, state: LifecycleState) -> TransitionCallbackReturn:
        """Close everything; the node may be configured again."""
        return self.on_shutdown(state)

    def _rest(self) -> None:
        self.active = False
        self.deactivate()

    def _attempt(self, work) -> TransitionCallbackReturn:
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
