# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The action: its place, progress, recording, its completeness, and every way to end early."""

import itertools
import os
import random
import re
import resource
import subprocess
import sys
import time
import uuid
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hasel_driver.nodes.experiment_server import PROMISE_S, OneAtATime
from hasel_driver.protocol.faults import FaultCode, RefusedError
from hasel_interfaces.action import RunExperiment
from hasel_interfaces.msg import BendingAngle
from hasel_recording.bag import read_file
from rclpy.action import ActionClient


@pytest.fixture
def clock():
    """A clock that stands until it is set: its only entry [s]."""
    return [0.0]


@pytest.fixture
def place(clock):
    """A place at that clock."""
    return OneAtATime(lambda: clock[0])


def test_is_promised_once_before_it_is_taken(place):
    """Two goals that arrive before the first has begun: the second is turned away."""
    assert (place.promise(), place.promise()) == (True, False)


def test_is_kept_while_taken_and_free_afterwards(place, clock):
    """However long the first takes."""
    place.promise()
    with place.taken():
        clock[0] += 10 * PROMISE_S
        assert not place.promise()
    assert place.promise()


def test_is_free_again_after_a_failure(place):
    """An experiment that raises does not keep others out."""
    with pytest.raises(OSError, match="full"), place.taken():
        raise OSError("the disk is full")
    assert place.promise()


def test_promise_lapses(place, clock):
    """An accepted goal that never begins does not keep others out for ever."""
    place.promise()
    clock[0] += PROMISE_S
    assert place.promise()


def test_late_goal_is_refused_while_another_runs(place):
    """In words: its promise had lapsed, and another took the place."""
    with place.taken(), pytest.raises(RefusedError, match="Another experiment is running"), place.taken():
        pass


STANDBY, ARMED, ACTIVE, FAULT = range(4)
SUCCEEDED, CANCELED, ABORTED = 4, 5, 6


@pytest.fixture
def run(ros):
    """Sends a goal; returns a function that waits for its end."""
    client = ActionClient(ros.node, RunExperiment, "/hasel/run_experiment")
    numbers = itertools.count()

    def begin(**changes):
        goal = {
            "voltage": 3000.0,
            "frequency": 4.0,
            "periods": 4,
            "waveform": "box",
            "polarity": "alternating",
            "duty": 1.0,
            "muscles": "both",
            "rest_time": 0.3,
            "output": f"{uuid.uuid4().hex}_{next(numbers)}",
        } | changes
        assert client.wait_for_server(10.0)
        feedback = []
        sent = client.send_goal_async(
            RunExperiment.Goal(**goal), feedback_callback=lambda message: feedback.append(message.feedback)
        )
        ros.wait(sent.done)
        handle = sent.result()

        def end(timeout_s: float = 15.0):
            answer = handle.get_result_async()
            ros.wait(answer.done, timeout_s)
            return answer.result().status, answer.result().result

        return handle, feedback, end

    yield begin
    client.destroy()


@pytest.fixture
def run_until_live(run, shared_rig, ros):
    """As `run`, but returns when the output is live; where it never is, the action's own words say why."""

    def begin(**changes):
        handle, feedback, end = run(**changes)
        assert handle.accepted
        ended = handle.get_result_async()
        ros.wait(lambda: shared_rig.live or ended.done())
        assert not ended.done(), ended.result().result.message
        return handle, feedback, end

    yield begin


def test_runs_records_and_reports_progress(driver, ros, run):
    """The recording holds rest, every drive of both muscles with its sign, and rest; progress goes from 0 to 1."""
    driver.arm()
    _, feedback, end = run()
    status, result = end()
    assert (status, result.success) == (SUCCEEDED, True), result.message
    progress = [message.progress for message in feedback]
    assert all(a <= b for a, b in pairwise(progress))
    assert (progress[0] < 0.2, progress[-1] > 0.8) == (True, True)
    assert max(abs(message.voltage[0]) for message in feedback) == 3000.0
    recording = read_file(Path(result.recording))
    states = recording.decoded("/hasel/state", "hasel_interfaces/msg/SupplyState")
    voltage = np.array([state.commanded_voltage for state in states])
    assert set(np.unique(voltage)) == {-3000.0, 0.0, 3000.0}
    assert np.count_nonzero(np.diff(voltage[:, 0]) > 1500) == 4
    stamps = np.array([s.header.stamp.sec + s.header.stamp.nanosec * 1e-9 for s in states])
    assert stamps[-1] - stamps[0] == pytest.approx(1.6, abs=0.15)
    first = stamps[np.argmax(voltage[:, 0] > 0)] - stamps[0]
    assert first == pytest.approx(0.3, abs=0.1)
    assert ros.await_mode(ARMED)


def test_cancel_grounds_and_keeps_what_was_recorded(driver, shared_rig, ros, run_until_live):
    """A cancelled run ends at 0 V, armed, with status cancelled."""
    driver.arm()
    handle, _, end = run_until_live(periods=100)
    cancelled_s = time.monotonic()
    ros.wait(handle.cancel_goal_async().done)
    status, result = end()
    assert shared_rig.await_live(False) - cancelled_s < 0.5
    assert (status, result.success, "cancelled" in result.message) == (CANCELED, False, True)
    assert len(read_file(Path(result.recording)).messages["/hasel/state"]) > 20
    ros.await_mode(ARMED)


@pytest.mark.rounds(2, 25)
@pytest.mark.parametrize("way", ["service", "topic"])
def test_emergency_stop_during_the_waveform(
    driver, shared_rig, ros, run_until_live, grounded_in_time, way, rounds
):
    """The stop grounds at any phase, the goal is aborted and says why, and the waveform does not come back."""
    for _ in range(rounds):
        driver.arm()
        _, _, end = run_until_live(periods=100)
        time.sleep(random.uniform(0.0, 0.5))
        at_s = time.monotonic()
        if way == "service":
            assert ros.trigger("emergency_stop").success
        else:
            ros.emergency_stop_topic(True)
        grounded_in_time(shared_rig, at_s)
        status, result = end()
        assert (status, "emergency stop" in result.message.lower()) == (ABORTED, True)
        assert not ros.trigger("arm").success
        assert (ros.await_mode(FAULT).fault_code, shared_rig.live) == (FaultCode.EMERGENCY_STOP, False)
        assert ros.false_claims(shared_rig, at_s) == []
        if way == "topic":
            ros.emergency_stop_topic(False)
        ros.wait(lambda: ros.trigger("clear_fault").success)


def test_a_command_during_the_waveform_is_a_second_master(driver, shared_rig, ros, run_until_live):
    """An experiment is not mixed with commands."""
    driver.arm()
    _, _, end = run_until_live(periods=100)
    ros.command((1000.0, 1000.0))
    shared_rig.await_live(False)
    status, result = end()
    assert (status, "more than one source of commands" in result.message) == (ABORTED, True)


def test_fails_when_the_recording_lacks_a_topic(driver, ros, run):
    """A tracker that falls silent during the run makes it a failure, and is named."""
    publisher = ros.node.create_publisher(BendingAngle, "/hasel/bending/measured", 10)
    try:
        driver.arm()
        ros.wait(lambda: publisher.get_subscription_count() > 0)
        _, _, end = run()
        status, result = end()
    finally:
        ros.node.destroy_publisher(publisher)
    assert (status, result.success) == (ABORTED, False)
    assert "no message of /hasel/bending/measured" in result.message


def test_a_full_disk_ends_the_run(driver, shared_rig, ros, run):
    """It is told, the output goes to zero, and the driver lives on."""
    unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
    resource.prlimit(driver.process.pid, resource.RLIMIT_FSIZE, (20_000, resource.RLIM_INFINITY))
    try:
        driver.arm()
        _, _, end = run(periods=1000)
        status, result = end()
    finally:
        resource.prlimit(driver.process.pid, resource.RLIMIT_FSIZE, unlimited)
    assert (status, result.success) == (ABORTED, False)
    assert re.search("written|finished", result.message)
    ros.await_mode(ARMED)
    assert not shared_rig.live


def test_no_recording_is_overwritten(driver, ros, run):
    """A file, a folder or a pipe that exists is left as it is, and the goal fails before anything is live."""
    taken = driver.folder / "taken.mcap"
    taken.write_bytes(b"precious")
    if not (driver.folder / "pipe.mcap").exists():
        os.mkfifo(driver.folder / "pipe.mcap")
    driver.arm()
    for output in ("taken", "taken.mcap", "pipe"):
        _, _, end = run(output=output)
        status, result = end()
        assert (status, "exists already" in result.message) == (ABORTED, True), result.message
    for output in ("/", "~nobody-there/x", "/tmp/elsewhere", "../elsewhere"):
        _, _, end = run(output=output)
        assert "is no file below" in (told := end()[1].message), told
    assert taken.read_bytes() == b"precious"
    ros.await_mode(ARMED)


def test_runs_without_a_rest_are_complete(driver, run):
    """A drive that begins before the first state is counted all the same."""
    driver.arm()
    for _ in range(6):
        _, _, end = run(
            rest_time=0.0, periods=2, frequency=5.0, output=f"without_rest_{time.monotonic_ns()}.mcap"
        )
        status, result = end()
        assert (status, result.success) == (SUCCEEDED, True), result.message


def test_a_client_that_ends_takes_the_voltage_with_it(driver, shared_rig, ros, run):
    """Nobody is left who could cancel: zero within a second."""
    from hasel_driver.testing.ros_client import another_node

    driver.arm()
    with another_node("experimenter") as node:
        client = ActionClient(node, RunExperiment, "/hasel/run_experiment")
        assert client.wait_for_server(10.0)
        sent = client.send_goal_async(RunExperiment.Goal(voltage=3000.0, frequency=1.0, periods=100))
        ros.wait(lambda: sent.done() and sent.result().accepted and shared_rig.live)
        client.destroy()
    left_s = time.monotonic()
    assert shared_rig.await_live(False, 5.0) - left_s < 1.0
    ros.await_mode(ARMED)
    for _ in range(20):  # until that experiment is wound up
        handle, _, end = run(periods=1)
        if handle.accepted:
            break
        time.sleep(0.1)
    assert end()[0] == SUCCEEDED


CLIENT = """
import rclpy
from hasel_interfaces.action import RunExperiment
from rclpy.action import ActionClient
rclpy.init()
node = rclpy.create_node("doomed")
client = ActionClient(node, RunExperiment, "/hasel/run_experiment")
client.wait_for_server()
client.send_goal_async(RunExperiment.Goal(voltage=3000.0, frequency=1.0, periods=1000))
rclpy.spin(node)
"""


@pytest.mark.slow
def test_a_client_that_is_killed_takes_the_voltage_with_it(driver, shared_rig, ros):
    """The middleware notices when its lease runs out: zero within 25 s, as the README says."""
    driver.arm()
    process = subprocess.Popen([sys.executable, "-c", CLIENT])
    try:
        ros.wait(lambda: shared_rig.live, 20.0)
        time.sleep(1.0)
    finally:
        process.kill()
        process.wait()
    killed_s = time.monotonic()
    ros.wait(lambda: ros.state.mode == ARMED and time.monotonic() - killed_s > 1.0 and _at_rest(ros), 30.0)
    assert time.monotonic() - killed_s < 25.0


def _at_rest(ros) -> bool:
    """Whether the last second's states are all at 0 V."""
    return not any(any(state.commanded_voltage) for state in list(ros.heard)[-100:])


def test_a_file_is_driven_and_recorded(driver, shared_rig, run):
    """The voltages of a CSV file, row by row, signs included."""
    path = driver.folder / "drive.csv"
    path.write_text(
        "time_s,voltage_upper_v,voltage_lower_v\n0,1000,0\n0.3,0,-2000\n0.6,1500,500\n0.9,0,0\n1,0,0\n"
    )
    driver.arm()
    _, _, end = run(waveform_file="drive.csv", rest_time=0.2)
    status, result = end()
    assert (status, result.success) == (SUCCEEDED, True), result.message
    states = read_file(Path(result.recording)).decoded("/hasel/state", "hasel_interfaces/msg/SupplyState")
    pairs = {tuple(state.commanded_voltage) for state in states}
    assert pairs == {(0.0, 0.0), (1000.0, 0.0), (0.0, -2000.0), (1500.0, 500.0)}
    stamps = [s.header.stamp.sec + s.header.stamp.nanosec * 1e-9 for s in states if any(s.commanded_voltage)]
    assert stamps[-1] - stamps[0] == pytest.approx(0.9, abs=0.1)


def test_one_experiment_at_a_time(driver, ros, run):
    """A second goal is rejected while one runs, and does not disturb it."""
    driver.arm()
    first, second = run(rest_time=1.0), run()
    assert (first[0].accepted, second[0].accepted) == (True, False)
    status, result = first[-1]()
    assert (status, result.success) == (SUCCEEDED, True), result.message


REFUSALS = {
    "the limit is 6000 V": {"voltage": 9000.0},
    "one of box, ramp, sine, triangle": {"waveform": "saw"},
    "frequency_hz is nan": {"frequency": float("nan")},
    "rest_time is -1.0 s": {"rest_time": -1.0},
    "duty is 0.0": {"duty": 0.0},
    "lasts 6e+06 s, at most 3600 s": {"frequency": 0.01, "periods": 60_000},
    "There is no waveform file": {"waveform_file": "no_such.csv"},
    "waveform_file: '/etc/shadow' is no file below": {"waveform_file": "/etc/shadow"},
    "output: '/proc/no/such/place.mcap' is no file below": {"output": "/proc/no/such/place.mcap"},
}


def test_refuses_what_cannot_be_done(driver, shared_rig, ros, run):
    """Not armed, or out of range: one sentence, and the output never was live."""
    ros.await_mode(STANDBY, 10.0)
    _, _, end = run()
    assert "needs the state ARMED" in end()[1].message
    driver.arm()
    shared_rig.changes.clear()
    for words, changes in REFUSALS.items():
        _, _, end = run(**changes)
        status, result = end()
        assert (status, words in result.message) == (ABORTED, True), result.message
    assert shared_rig.changes == []
    ros.await_mode(ARMED)
