# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The action `run_experiment`: runs a plan, records it, and vouches for the recording."""

import contextlib
import importlib
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from hasel_common.endpoints import Role
from hasel_common.managed_node import quiet_at_shutdown
from hasel_common.provenance import provenance
from hasel_common.topics import STATE, TOPIC_TYPES, known_as, relative
from hasel_interfaces.action import RunExperiment
from hasel_interfaces.msg import SupplyState
from hasel_recording.errors import RecordingError
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.action.server import ServerGoalHandle
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node
from rclpy.subscription import Subscription

from hasel_driver.nodes.experiment_goal import plan_of
from hasel_driver.nodes.experiment_recording import ExperimentRecording, chosen_path, reserve, reserve_unique
from hasel_driver.nodes.parameters import values
from hasel_driver.protocol.faults import DriverError, RefusedError
from hasel_driver.safety.driven_experiment import ExperimentPlan, ExperimentProgress
from hasel_driver.safety.supply_link import SupplyLink

FEEDBACK = "run_experiment/_action/feedback"  # to which every client of the action subscribes
GRACE_S = 0.3
PROMISE_S = 2.0
FEEDBACK_PERIOD_S = 0.1


class ClientWatch:
    """Whether whoever asked for an experiment is still there.

    Notes the action's clients of now; which of them sent the goal ROS does not tell, so each of them must stay.
    A client that ends is noticed at once, one that is killed when its lease with the middleware runs out (20 s).
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._clients = self._present()
        self._missed_s: float | None = None

    def gone(self) -> str | None:
        """The name of one that has been gone for a moment."""
        present = self._present()
        missed = [name for identifier, name in self._clients.items() if identifier not in present]
        if not missed:
            self._missed_s = None
            return None
        now_s = time.monotonic()
        self._missed_s = now_s if self._missed_s is None else self._missed_s
        return missed[0] if now_s - self._missed_s > GRACE_S else None

    def _present(self) -> dict[bytes, str]:
        return {
            bytes(info.endpoint_gid): info.node_name
            for info in self._node.get_subscriptions_info_by_topic(FEEDBACK)
        }


class OneAtATime:
    """A place for one: promised when a goal is accepted, taken when it begins.

    Between the two other goals may arrive: the promise keeps them out.

    A goal whose acceptance could not be sent never begins, so a promise lapses after `PROMISE_S`.
    """

    def __init__(self, clock_s: Callable[[], float] = time.monotonic) -> None:
        self._clock_s = clock_s
        self._lock = threading.Lock()
        self._taken = False
        self._promised_until_s = -float("inf")

    def promise(self) -> bool:
        """Whether the place is free; if so it is kept for who asked."""
        with self._lock:
            if self._taken or self._clock_s() < self._promised_until_s:
                return False
            self._promised_until_s = self._clock_s() + PROMISE_S
            return True

    @contextmanager
    def taken(self) -> Iterator[None]:
        """Hold the place. Raises RefusedError where another holds it."""
        with self._lock:
            if self._taken:
                raise RefusedError("Another experiment is running: wait for its end, or cancel it.")
            self._taken = True
            self._promised_until_s = -float("inf")
        try:
            yield
        finally:
            with self._lock:
                self._taken = False


class ExperimentServer:
    """One experiment at a time, run by the safety process."""

    def __init__(self, node: Node, link: Callable[[], SupplyLink | None], group: CallbackGroup) -> None:
        self._node, self._link, self._group = node, link, group
        self._state_topic = node.resolve_topic_name(relative(STATE))
        self._recording: ExperimentRecording | None = None
        self._watched: list[Subscription] = []
        self._place = OneAtATime()
        self._server = ActionServer(
            node,
            RunExperiment,
            "run_experiment",
            self._execute,
            goal_callback=self._accept,
            cancel_callback=lambda _: CancelResponse.ACCEPT,
            callback_group=group,
        )

    def watch_topics(self, topics: Iterable[str]) -> None:
        """Subscribe to what is to be recorded, before it is needed: discovery takes time."""
        for subscription in self._watched:
            self._node.destroy_subscription(subscription)
        topics = [topic for topic in topics if topic]  # ROS cannot tell the type of an empty list
        known = {topic: kind for topic in topics if (kind := known_as(topic)) is not None}
        for topic in set(topics) - set(known):
            self._node.get_logger().warning(f"The type of {topic} is not known: it will not be recorded.")
        self._watched = [
            self._node.create_subscription(
                _message_class(TOPIC_TYPES[kind]),
                topic,
                self._writer(self._node.resolve_topic_name(topic)),
                Role.SAMPLES.value,
                callback_group=self._group,
            )
            for topic, kind in known.items()
        ]

    def record_state(self, message: SupplyState) -> None:
        """Called with each state that is published; a state that does not know the voltage is not a sample of it."""
        recording = self._recording
        if recording is not None and message.commanded_voltage[0] == message.commanded_voltage[0]:
            recording.write(self._state_topic, message)

    def _writer(self, topic: str) -> Callable[[Any], None]:
        def write(message: Any) -> None:
            recording = self._recording
            if recording is not None:
                recording.write(topic, message)

        return write

    def _accept(self, _: RunExperiment.Goal) -> GoalResponse:
        return GoalResponse.ACCEPT if self._place.promise() else GoalResponse.REJECT

    def _execute(self, goal_handle: ServerGoalHandle) -> RunExperiment.Result:
        result = RunExperiment.Result()
        try:
            with self._place.taken(), self._cleared_at_its_end():
                folder = Path(self._node.get_parameter("waveform_directory").value).expanduser()
                plan = plan_of(goal_handle.request, folder)
                problems = self._run(plan, goal_handle, result)
        except (DriverError, RecordingError, OSError) as error:
            problems = [str(error)]
        result.success = not problems
        result.message = "; ".join(problems) or f"Recorded {plan.duration_s:.2f} s in {result.recording}."
        if problems:
            self._node.get_logger().error(f"The experiment failed: {result.message}")
        with quiet_at_shutdown():
            _conclude(goal_handle, result.success)
        return result

    @contextmanager
    def _cleared_at_its_end(self) -> Iterator[None]:
        try:
            yield
        finally:
            recording, self._recording = self._recording, None
            if recording is not None:
                recording.close()

    def _run(
        self, plan: ExperimentPlan, goal_handle: ServerGoalHandle, result: RunExperiment.Result
    ) -> list[str]:
        """What went wrong, in words; nothing if the run and its recording are complete."""
        link = self._link()
        if link is None:
            raise RefusedError("The port is closed: configure the node (lifecycle) first.")
        topics = tuple(s.topic_name for s in self._watched if self._node.count_publishers(s.topic_name))
        link.ask("begin_experiment", plan)
        with contextlib.ExitStack() as on_failure:
            on_failure.callback(link.tell, "cancel_experiment", "its recording failed")
            path = self._reserve(goal_handle.request, plan)
            recording = self._recording = ExperimentRecording(
                path, plan, topics, self._state_topic, self._made_by(link.now.name or "")
            )
            result.recording = str(path)
            link.ask("run_experiment")
            progress = self._follow(link, goal_handle, plan, recording)
            on_failure.pop_all()
        if recording.problem:
            raise RecordingError(recording.problem)
        recording.close()
        if progress.failure:
            return [progress.failure]
        return [f"the recording lacks: {text}" for text in recording.missing(progress.elapsed_s)]

    def _follow(
        self,
        link: SupplyLink,
        goal_handle: ServerGoalHandle,
        plan: ExperimentPlan,
        recording: ExperimentRecording,
    ) -> ExperimentProgress:
        """Until the run is over; cancelled where its client asks, or is gone, or nothing more can be recorded."""
        client = ClientWatch(self._node)
        while True:
            if not link.is_alive():
                raise RefusedError("The safety process has ended; the board grounds itself.")
            progress = link.now.experiment
            if progress is None or progress.finished:
                return progress or ExperimentProgress(0.0, (0.0, 0.0), True, "it was not begun")
            if goal_handle.is_cancel_requested or recording.problem:
                link.tell("cancel_experiment", "it was cancelled")
            elif (name := client.gone()) is not None:
                link.tell("cancel_experiment", f"its client {name} has gone")
            with quiet_at_shutdown():
                goal_handle.publish_feedback(_feedback(progress, plan.duration_s))
            time.sleep(FEEDBACK_PERIOD_S)

    def _made_by(self, supply: str) -> dict[str, str]:
        """The supply, this package's version, and the node's parameters: its limits among them."""
        node = self._node.get_fully_qualified_name()
        return provenance(node, ("hasel_driver", "hasel_recording"), {"supply": supply, **values(self._node)})

    def _reserve(self, goal: RunExperiment.Goal, plan: ExperimentPlan) -> Path:
        folder = Path(self._node.get_parameter("recording_directory").value).expanduser()
        if goal.output:
            return reserve(chosen_path(folder, goal.output))
        rate = "file" if goal.waveform_file else goal.preset or f"{goal.frequency:g}Hz"
        return reserve_unique(folder, f"{plan.waveform.voltage_v:.0f}V_{rate}")


def _message_class(type_name: str) -> type:
    package, kind, name = type_name.split("/")
    return getattr(importlib.import_module(f"{package}.{kind}"), name)


def _conclude(goal_handle: ServerGoalHandle, success: bool) -> None:
    if goal_handle.is_cancel_requested:
        goal_handle.canceled()
    elif success:
        goal_handle.succeed()
    else:
        goal_handle.abort()


def _feedback(progress: ExperimentProgress, duration_s: float) -> RunExperiment.Feedback:
    elapsed_s = min(progress.elapsed_s, duration_s)
    return RunExperiment.Feedback(
        progress=elapsed_s / duration_s,
        elapsed=elapsed_s,
        remaining=duration_s - elapsed_s,
        voltage=list(progress.voltage_v),
    )
