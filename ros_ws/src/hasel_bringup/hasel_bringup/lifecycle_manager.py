# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`ros2 run hasel_bringup lifecycle_manager`: brings the nodes up in order, and the driver down when another ends."""

import threading
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from enum import Enum

from hasel_common.declared_parameters import declare
from hasel_common.diagnostics import Diagnostics, Level, Part
from hasel_common.endpoints import STEADY
from hasel_common.node_process import run_node
from hasel_common.topics import NAMESPACE
from lifecycle_msgs.msg import State, Transition
from lifecycle_msgs.srv import ChangeState, GetState
from rclpy.client import Client
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Trigger

from hasel_bringup.bringup_parameters import LIFECYCLE_MANAGER
from hasel_bringup.errors import BringupError


class Lifecycle(Enum):
    """Where a node is; ABSENT: nobody answers to its name."""

    ABSENT = "absent"
    UNCONFIGURED = "unconfigured"
    INACTIVE = "inactive"
    ACTIVE = "active"


class Change(Enum):
    """What a node is asked for."""

    CONFIGURE = "configure"
    ACTIVATE = "activate"
    DEACTIVATE = "deactivate"
    CLEANUP = "clean up"


UP = {Lifecycle.UNCONFIGURED: Change.CONFIGURE, Lifecycle.INACTIVE: Change.ACTIVATE}
DOWN = {Lifecycle.ACTIVE: Change.DEACTIVATE, Lifecycle.INACTIVE: Change.CLEANUP}
States = Mapping[str, Lifecycle]


class BringUp:
    """names: in the order in which they go up, and down; the first is the supply's driver.

    Nobody goes up before all are there. When one ends, the first goes down, until all are there again. What somebody
    else has taken down is left to them.
    """

    def __init__(self, names: Sequence[str], up: bool = True) -> None:
        self._names = tuple(names)
        self.up = up
        self._brought: set[str] = set()

    def startup(self) -> None:
        """From now on up, also what somebody took down."""
        self.up = True
        self._brought.clear()

    def shutdown(self) -> None:
        """From now on down."""
        self.up = False

    def next_change(self, states: States) -> tuple[str, Change] | None:
        """Who is to be asked for what, if anybody."""
        if not self.up:
            return self._first_of(DOWN, states)
        first, ended = self._names[0], self.ended(states)
        if ended or self.absent(states):
            self._brought -= {first, *ended}
            if states[first] is Lifecycle.ACTIVE:
                return first, Change.DEACTIVATE
        if self.absent(states):
            return None
        wanted = self._first_of(UP, states, but=self._brought)
        if wanted is None:
            self._brought = set(self._names)
        return wanted

    def ended(self, states: States) -> list[str]:
        """Who was brought up and is not there any more, or is there anew."""
        return [name for name in self._names if name in self._brought and states[name] not in DOWN]

    def absent(self, states: States) -> list[str]:
        """Who is not there."""
        return [name for name in self._names if states[name] is Lifecycle.ABSENT]

    def _first_of(
        self, changes: Mapping[Lifecycle, Change], states: States, but: Collection[str] = ()
    ) -> tuple[str, Change] | None:
        wanted = (
            (name, change)
            for before, change in changes.items()
            for name in self._names
            if states[name] is before and name not in but
        )
        return next(wanted, None)


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
        declare(self, LIFECYCLE_MANAGER)
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

    def _serve(
        self, wish: Callable[[], None], answer: str
    ) -> Callable[[Trigger.Request, Trigger.Response], Trigger.Response]:
        def serve(_: Trigger.Request, response: Trigger.Response) -> Trigger.Response:
            wish()
            summary = ", ".join(f"{name} {state.value}" for name, state in self._states.items())
            response.success, response.message = True, f"{answer} {summary}"
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
            common = " or ".join(sorted({state.value for state in states.values()}))
            self._say(f"Waiting for {', '.join(absent)}." if absent else f"All are {common}.")
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

    def _tell(self) -> None:
        up = self._bring_up.up
        well = all(state is Lifecycle.ACTIVE for state in self._states.values()) or not up
        states = {name: state.value for name, state in self._states.items()}
        self._diagnostics.tell(Level.OK if well else Level.WARN, self._said, states)


def main() -> int:
    """Run the node until it is interrupted; returns the exit code."""
    return run_node(LifecycleManager, errors=(BringupError,))
