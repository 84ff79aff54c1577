"""The action `run_experiment`: runs a plan, records it, and vouches for the recording."""

import contextlib
import importlib
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from hasel_common.endpoints import Role
from hasel_common.managed_node import quiet_at_shutdown
from hasel_common.provenance import provenance
from hasel_common.topics import STATE, TOPIC_TYPES, known_as, relative
from hasel_interfaces.action import RunExperiment
from hasel_interfaces.msg import SupplyState
from hasel_recording.errors import RecordingError
from rclpy.action import ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import CallbackGroup
from rclpy.node import Node

from hasel_driver.client_watch import ClientWatch
from hasel_driver.errors import DriverError, LimitError, RefusedError
from hasel_driver.experiment import ExperimentPlan, ExperimentProgress
from hasel_driver.experiment_recording import ExperimentRecording
from hasel_driver.node_parameters import values
from hasel_driver.one_at_a_time import OneAtATime
from hasel_driver.presets import preset
from hasel_driver.recording_path import below, chosen_path, reserve, reserve_unique
from hasel_driver.supply_link import SupplyLink
from hasel_driver.waveform import Waveform
from hasel_driver.waveform_file import read_waveform

FEEDBACK_PERIOD_S = 0.1


class ExperimentServer:
    """One experiment at a time, run by the safety process."""

    def __init__(self, node: Node, link: Callable[[], SupplyLink | None], group: CallbackGroup) -> None:
        self._node, self._link, self._group = node, link, group
        self._state_topic = node.resolve_topic_name(relative(STATE))
        self._recording: ExperimentRecording | None = None
        self._watched: list = []
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

    def _writer(self, topic: str) -> Callable:
        def write(message) -> None:
            recording = self._recording
            if recording is not None:
                recording.write(topic, message)

        return write

    def _accept(self, _: RunExperiment.Goal) -> GoalResponse:
        return GoalResponse.ACCEPT if self._place.promise() else GoalResponse.REJECT

    def _execute(self, goal_handle) -> RunExperiment.Result:
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

    def _run(self, plan: ExperimentPlan, goal_handle, result: RunExperiment.Result) -> list[str]:
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
        self, link: SupplyLink, goal_handle, plan: ExperimentPlan, recording: ExperimentRecording
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


def _conclude(goal_handle, success: bool) -> None:
    if goal_handle.is_cancel_requested:
        goal_handle.canceled()
    elif success:
        goal_handle.succeed()
    else:
        goal_handle.abort()


def plan_of(goal: RunExperiment.Goal, waveforms: Path) -> ExperimentPlan:
    """What a goal asks for, its waveform files below `waveforms`. Raises LimitError or RecordingError."""
    if goal.preset and goal.waveform_file:
        raise LimitError(
            f"The goal names the preset {goal.preset!r} and the file {goal.waveform_file!r}: give one of the two."
        )
    if goal.waveform_file:
        return ExperimentPlan(
            read_waveform(below(waveforms, goal.waveform_file, "waveform_file")), goal.rest_time
        )
    if goal.preset:
        chosen = preset(goal.preset)
        muscle = "upper" if goal.muscles == RunExperiment.Goal.BOTH else goal.muscles
        return ExperimentPlan(chosen.waveform(goal.voltage, muscle), goal.rest_time or chosen.rest_s)
    waveform = Waveform(
        shape=goal.waveform,
        voltage_v=goal.voltage,
        frequency_hz=goal.frequency,
        periods=goal.periods,
        duty=goal.duty,
        polarity=goal.polarity,
        muscles=goal.muscles,
    )
    return ExperimentPlan(waveform, goal.rest_time)


def _feedback(progress: ExperimentProgress, duration_s: float) -> RunExperiment.Feedback:
    elapsed_s = min(progress.elapsed_s, duration_s)
    return RunExperiment.Feedback(
        progress=elapsed_s / duration_s,
        elapsed=elapsed_s,
        remaining=duration_s - elapsed_s,
        voltage=list(progress.voltage_v),
    )
