"""`ros2 run hasel_bringup lifecycle_manager`: brings the nodes up in order, and the driver down when another ends."""

import threading
import time
from collections.abc import Callable, Collection

from hasel_common.declared_parameters import declare
from hasel_common.diagnostics import Diagnostics, Level, Part
from hasel_common.endpoints import STEADY
from hasel_common.topics import NAMESPACE
from hasel_sim.node_process import run_node
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Trigger

from hasel_bringup.errors import BringupError
from hasel_bringup.lifecycle_manager.bring_up import BringUp, Change, Lifecycle
from hasel_bringup.lifecycle_manager.manager_parameters import PARAMETERS

PERIOD_S = 0.5
CONFIGURE_S = 60.0  # a model is compiled, a camera opened
RETRY_S = 2.0  # after a transition that failed
SAID_AGAIN_S = 10.0
STATES = {
    State.PRIMARY_STATE_UNCONFIGURED: Lifecycle.UNCONFIGURED,
    State.PRIMARY_STATE_INACTIVE: Lifecycle.INACTIVE,
    State.PRIMARY_STATE_ACTIVE: Lifecycle.ACTIVE,
}
TRANSITIONS = {
    Change.CONFIGURE: Transition.TRANSITION_CONFIGURE,
    Change.ACTIVATE: Transition.TRANSITION_ACTIVATE,
    Change.DEACTIVATE: Transition.TRANSITION_DEACTIVATE,
    Change.CLEANUP: Transition.TRANSITION_CLEANUP,
}


class LifecycleManager(Node):
    """Asks for states and changes in a thread of its own; see BringUp for what it asks for."""

    def __init__(self) -> None:
        super().__init__("lifecycle_manager", namespace=NAMESPACE)
        declare(self, PARAMETERS)
        self._names = tuple(self.get_parameter("nodes").value)
        if not all(self._names):
            raise BringupError("The parameter nodes is empty: name the nodes that are to be brought up.")
        self._answer_s = self.get_parameter("answer_time").value
        self._ask = {name: self.create_client(GetState, f"{name}/get_state") for name in self._names}
        self._change = {name: self.create_client(ChangeState, f"{name}/change_state") for name in self._names}
        self._bring_up = BringUp(self._names, self.get_parameter("autostart").value)
        self._states = dict.fromkeys(self._names, Lifecycle.ABSENT)
        self._said, self._said_s = "", 0.0
        self.create_service(
            Trigger, "lifecycle_manager/startup", self._serve(self._bring_up.startup, "Going up.")
        )
        self.create_service(
            Trigger, "lifecycle_manager/shutdown", self._serve(self._bring_up.shutdown, "Going down.")
        )
        self._diagnostics = Diagnostics(self, Part.NODES)
        self.create_timer(1.0, self._tell, clock=STEADY)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._work, name="lifecycles", daemon=True)
        self._thread.start()

    def destroy_node(self) -> None:
        """End the thread and leave; the nodes stay as they are."""
        self._ended.set()
        self._thread.join(timeout=self._answer_s)
        super().destroy_node()

    def _serve(self, wish: Callable[[], None], answer: str) -> Callable:
        def serve(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            wish()
            response.success, response.message = True, f"{answer} {self._summary()}"
            return response

        return serve

    def _work(self) -> None:
        wait_s = 0.0
        while not self._ended.wait(wait_s):
            wait_s = self._step()

    def _step(self) -> float:
        """Look, and have one thing changed where one is to be; how long to wait afterwards [s]."""
        states = self._asked()
        self._states = states
        for name in self._bring_up.ended(states):
            self.get_logger().error(f"{name} has ended: {self._names[0]} is deactivated until it is back.")
        wanted = self._bring_up.next_change(states)
        if wanted is None:
            absent = self._bring_up.absent(states)
            self._say(f"Waiting for {', '.join(absent)}." if absent else f"All are {_common(states)}.")
            return PERIOD_S
        name, change = wanted
        if self._do(name, change):
            return 0.0
        self._say(f"{name} could not {change.value}: its own log says why. Trying again.")
        return RETRY_S

    def _asked(self) -> dict[str, Lifecycle]:
        """The state of every node; all are asked at once."""
        asked = {
            name: c.call_async(GetState.Request()) for name, c in self._ask.items() if c.service_is_ready()
        }
        self._await(asked.values(), self._answer_s)
        states = dict.fromkeys(self._names, Lifecycle.ABSENT)
        for name, future in asked.items():
            if future.done() and (answer := future.result()) is not None:
                states[name] = STATES.get(answer.current_state.id, self._states[name])
            else:
                self._ask[name].remove_pending_request(future)
        return states

    def _do(self, name: str, change: Change) -> bool:
        request = ChangeState.Request()
        request.transition.id = TRANSITIONS[change]
        client: Client = self._change[name]
        future = client.call_async(request)
        self._await([future], max(self._answer_s, CONFIGURE_S if change is Change.CONFIGURE else 0.0))
        if not future.done():
            client.remove_pending_request(future)
        return future.done() and bool(future.result().success)

    def _await(self, futures: Collection[Future], seconds: float) -> None:
        """Until all have their answers, the time is over, or this node ends."""
        end_s = time.monotonic() + seconds
        while not all(future.done() for future in futures) and time.monotonic() < end_s:
            if self._ended.wait(0.005):
                return

    def _say(self, what: str) -> None:
        if what != self._said or (
            not what.startswith("All") and time.monotonic() - self._said_s > SAID_AGAIN_S
        ):
            self.get_logger().info(what)
            self._said, self._said_s = what, time.monotonic()

    def _summary(self) -> str:
        return ", ".join(f"{name} {state.value}" for name, state in self._states.items())

    def _tell(self) -> None:
        up = self._bring_up.up
        well = all(state is Lifecycle.ACTIVE for state in self._states.values()) or not up
        states = {name: state.value for name, state in self._states.items()}
        self._diagnostics.tell(Level.OK if well else Level.WARN, self._said, states)


def _common(states: dict[str, Lifecycle]) -> str:
    return " or ".join(sorted({state.value for state in states.values()}))


def main() -> int:
    """Run the node until it is interrupted; returns the exit code."""
    return run_node(LifecycleManager, errors=(BringupError,))
