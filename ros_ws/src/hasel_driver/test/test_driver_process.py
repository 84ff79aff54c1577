# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What happens to the process: killed, frozen, ended, without a port, started after an emergency stop."""

import math
import os
import pty
import random
import signal
import subprocess
import sys
import time

import pytest
from hasel_driver.protocol.faults import FaultCode

STANDBY, ARMED, ACTIVE, FAULT = range(4)


@pytest.mark.rounds(2, 30)
def test_killed_node(start_driver, rig, ros, grounded_in_time, rounds):
    """After SIGKILL the supply grounds itself within 500 ms; the next node does not arm, though commands come."""
    with ros.commanding():
        for _ in range(rounds):
            driver = start_driver(rig.port)
            ros.await_mode(STANDBY)
            assert not rig.live
            driver.arm()
            ros.wait(lambda: rig.live)
            time.sleep(random.uniform(0.0, 0.1))
            killed_s = time.monotonic()
            driver.process.kill()
            grounded_in_time(rig, killed_s)
        start_driver(rig.port)
        ros.await_mode(STANDBY)
        time.sleep(0.2)
        assert not rig.live


@pytest.mark.rounds(1, 20)
def test_frozen_node(start_driver, virtual_rig, ros, grounded_in_time, rounds):
    """A node that stands still for half a second and goes on finds itself in FAULT, though commands come."""
    driver = start_driver(virtual_rig.port)
    with ros.commanding():
        for _ in range(rounds):
            driver.arm()
            ros.wait(lambda: virtual_rig.live)
            frozen_s = time.monotonic()
            driver.process.send_signal(signal.SIGSTOP)
            grounded_in_time(virtual_rig, frozen_s)
            time.sleep(max(0.0, frozen_s + 0.5 - time.monotonic()))
            driver.process.send_signal(signal.SIGCONT)
            ros.await_mode(FAULT)
            assert not virtual_rig.live
            assert ros.false_claims(virtual_rig, frozen_s) == []
            assert ros.trigger("clear_fault").success


@pytest.mark.rounds(1, 20)
@pytest.mark.parametrize(
    "numbers",
    [(signal.SIGINT,), (signal.SIGINT, signal.SIGINT), (signal.SIGTERM,)],
    ids=["Ctrl-C", "Ctrl-C as from a launch file", "service manager's stop"],
)
def test_ended_node(start_driver, virtual_rig, ros, grounded_in_time, numbers, rounds):
    """Whoever ends it, it grounds at once, and ends without a stack trace or a false alarm."""
    for _ in range(rounds):
        driver = start_driver(virtual_rig.port)
        driver.arm()
        with ros.commanding():
            ros.wait(lambda: virtual_rig.live)
            ended_s = time.monotonic()
            for number in numbers:
                driver.process.send_signal(number)
                time.sleep(0.01)
            grounded_in_time(virtual_rig, ended_s)
        assert driver.process.wait(5.0) == 0
        driver.close()
        log = "".join(driver.log)
        assert "Traceback" not in log
        assert "Illegal" not in log


@pytest.mark.rounds(1, 15)
def test_ended_during_an_experiment(start_driver, virtual_rig, ros, tmp_path, grounded_in_time, rounds):
    """Ctrl-C in the middle of a run grounds, and what was recorded can be read."""
    from hasel_interfaces.action import RunExperiment
    from hasel_recording.bag import read_file
    from rclpy.action import ActionClient

    client = ActionClient(ros.node, RunExperiment, "/hasel/run_experiment")
    for index in range(rounds):
        driver = start_driver(virtual_rig.port, recording_directory=tmp_path)
        path = tmp_path / f"{index}.mcap"
        driver.arm()
        assert client.wait_for_server(10.0)
        client.send_goal_async(
            RunExperiment.Goal(voltage=3000.0, frequency=1.0, periods=100, output=str(path))
        )
        ros.wait(lambda: virtual_rig.live)
        time.sleep(random.uniform(0.2, 0.4))
        ended_s = time.monotonic()
        driver.process.send_signal(signal.SIGINT)
        grounded_in_time(virtual_rig, ended_s)
        assert driver.process.wait(5.0) == 0
        driver.close()
        assert "Traceback" not in "".join(driver.log)
        assert len(read_file(path).messages["/hasel/state"]) > 5
    client.destroy()


@pytest.mark.rounds(1, 15)
def test_pulled_cable(start_driver, virtual_rig, ros, tmp_path, grounded_in_time, rounds):
    """State and diagnostics say that nothing is known; only clear_fault connects again, to STANDBY."""
    link = tmp_path / "supply"
    link.symlink_to(virtual_rig.port)
    driver = start_driver(link)
    for _ in range(rounds):
        driver.arm()
        with ros.commanding():
            ros.wait(lambda: virtual_rig.live)
            pulled_s = time.monotonic()
            virtual_rig.say("unplug")
            grounded_in_time(virtual_rig, pulled_s)
            state = ros.await_mode(FAULT)
            assert state.fault_code == FaultCode.LINK_LOST
            assert "Nothing proves the output grounded" in state.fault_text
            assert all(math.isnan(value) for value in (*state.commanded_voltage, *state.measured_voltage))
            answer = ros.trigger("clear_fault")
            assert (answer.success, "cannot be opened" in answer.message) == (False, True)
            virtual_rig.replug()
            link.unlink()
            link.symlink_to(virtual_rig.port)
            time.sleep(0.3)
            assert ros.state.mode == FAULT
            assert ros.trigger("clear_fault").success
            ros.await_mode(STANDBY)
            assert not virtual_rig.live
        assert ros.false_claims(virtual_rig, pulled_s) == []


def test_a_second_driver_on_the_port_ends(start_driver, virtual_rig, ros):
    """The first has it alone and goes on; the second ends with a sentence instead of answering the services."""
    first = start_driver(virtual_rig.port)
    first.arm()
    with ros.commanding():
        ros.wait(lambda: virtual_rig.live)
        second = start_driver(virtual_rig.port)
        assert second.process.wait(15.0) == 1
        second.close()
        assert virtual_rig.live
    assert any("another program has it open" in line and "This node ends" in line for line in second.log)
    assert ros.trigger("disarm").success


def test_a_port_that_comes_later_is_opened(start_driver, virtual_rig, ros, tmp_path):
    """What failed at the start is tried again, and said once."""
    link = tmp_path / "supply"
    driver = start_driver(link)
    ros.wait(lambda: any("cannot be opened" in line for line in driver.log), 15.0)
    time.sleep(2.5)
    assert sum("cannot be opened" in line for line in driver.log) == 1
    link.symlink_to(virtual_rig.port)
    ros.await_mode(STANDBY, 15.0)
    driver.arm()


def test_the_last_state_is_true(start_driver, virtual_rig, ros):
    """A driver that is ended while live says at last that the supply is in STANDBY and grounded, as it is."""
    driver = start_driver(virtual_rig.port)
    driver.arm()
    with ros.commanding():
        ros.wait(lambda: bool(ros.states) and ros.state.measured_voltage[1] < -1900)
        driver.process.terminate()
        assert driver.process.wait(5.0) == 0
    time.sleep(0.2)
    assert (ros.state.mode, ros.state.grounded, virtual_rig.live) == (STANDBY, True, False)


def test_simulated_time_without_a_clock_watches_all_the_same(start_driver, virtual_rig, ros):
    """With use_sim_time and nobody who publishes /clock, another driver is a fault as ever."""
    driver = start_driver(virtual_rig.port, use_sim_time=True)
    driver.arm()
    from hasel_driver.testing.ros_client import another_node
    from hasel_interfaces.msg import SupplyState

    with ros.commanding():
        ros.wait(lambda: virtual_rig.live)
        with another_node("stranger") as node:
            node.create_publisher(SupplyState, "/hasel/state", 10)
            ros.wait(lambda: ros.state.fault_code == FaultCode.TWO_DRIVERS, 10.0)


STARTS = {
    "did you mean 'maximum_voltage'": {"maximum_voltge": 200.0},
    "There is no parameter 'voltage_limit'": {"voltage_limit": 200},
    "maximum_voltage is nan V, 0 to 9800": {"maximum_voltage": ".nan"},
    "realtime_priority is 99": {"realtime_priority": 99},
    "use_sim_time": {"use_sim_time": "maybe"},
    "s in all, less than 0.5 s": {"heartbeat_timeout": 0.45, "dead_time": 0.05, "maximum_voltage": 9800},
    "Did you mean hasel?": {"backend": "Hasel"},
    "0 to 9800 was expected": {"maximum_voltage": 20000},
    "maximum_voltage is 'high', a number was expected": {"maximum_voltage": "high"},
}


@pytest.mark.parametrize("words", STARTS)
def test_a_wrong_parameter_is_one_sentence(start_driver, ros, words):
    """Misspelt, of another kind or out of range: the node ends with what was expected."""
    driver = start_driver("/dev/no-such-port", **STARTS[words])
    assert driver.process.wait(15.0) == 1
    driver.close()
    log = "".join(driver.log)
    assert words in log
    assert "Traceback" not in log


def test_a_whole_number_is_a_voltage(start_driver, virtual_rig, ros):
    """`-p maximum_voltage:=200`, as the README's checklist says, is 200 V."""
    start_driver(virtual_rig.port, maximum_voltage=200)
    assert ros.await_mode(STANDBY, 15.0).maximum_voltage == 200.0


def test_an_open_interlock_at_the_start_is_told_and_closed_later(start_driver, virtual_rig, ros):
    """The state tells which channel is open; once both were open together the fault is cleared, and the driver arms."""
    virtual_rig.say("interlock_b")
    driver = start_driver(virtual_rig.port)
    assert ros.await_mode(FAULT, 15.0).fault_code == FaultCode.DISCREPANCY
    assert ros.state.interlock.tolist() == [2, 1]
    assert "interlock is open" in ros.trigger("clear_fault").message
    virtual_rig.say("recover")
    time.sleep(0.1)
    assert "disagreed" in ros.trigger("clear_fault").message
    virtual_rig.say("interlock")
    time.sleep(0.1)
    virtual_rig.say("recover")
    time.sleep(0.1)
    assert ros.trigger("clear_fault").success
    driver.arm()


def test_a_device_that_is_no_supply_is_opened_once(start_driver, ros):
    """Each opening resets a board: the node says what is there, and ends."""
    board, port = pty.openpty()
    driver = start_driver(os.ttyname(port))
    assert driver.process.wait(20.0) == 1
    driver.close()
    os.close(board)
    log = "".join(driver.log)
    assert log.count("check that it is the supply") == 2  # in the log, and as its last word
    assert "Traceback" not in log


def test_missing_port_is_said_in_one_sentence(start_driver, ros):
    """Without the port the node stays unconfigured and says what to do."""
    driver = start_driver("/dev/no-such-port")
    ros.wait(lambda: any("cannot be opened" in line for line in driver.log), 10.0)
    assert "port is closed" in ros.trigger("arm").message
    assert driver.process.poll() is None
    assert "Traceback" not in "".join(driver.log)


def test_topic_is_obeyed_by_a_driver_that_starts_later(start_driver, virtual_rig, ros):
    """The stop is latched in the topic: a driver started afterwards comes up stopped and cannot be armed."""
    ros.emergency_stop_topic(True)
    for fault_codes in ((FaultCode.EMERGENCY_STOP,), (FaultCode.STOP, FaultCode.EMERGENCY_STOP)):
        driver = start_driver(virtual_rig.port, discovery_time=1.0)
        # the second time the board tells of the first driver's stop, which may come before the topic does
        assert ros.await_mode(FAULT, 10.0).fault_code in fault_codes
        ros.wait(lambda: ros.state.fault_code == FaultCode.EMERGENCY_STOP, 10.0)
        assert not ros.trigger("arm").success
        assert not ros.trigger("clear_fault").success
        driver.close()
    assert virtual_rig.changes == []


PARENT = """
import subprocess, sys, time
subprocess.Popen([sys.executable, "-m", "hasel_driver.nodes.driver_node", "--ros-args", *sys.argv[1:]])
time.sleep(1000)
"""


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM])
def test_the_driver_ends_grounded_with_its_parent(virtual_rig, ros, tmp_path, grounded_in_time, number):
    """As when a launch is killed, which leaves its nodes behind: grounded, and nobody holds the port any more."""
    words = [f"port:={virtual_rig.port}", "discovery_time:=0.2", f"state_folder:={tmp_path}"]
    words.append(f"history_file:={tmp_path}/history.jsonl")
    ros.states.clear()
    given = [each for word in words for each in ("-p", word)]
    parent = subprocess.Popen([sys.executable, "-c", PARENT, *given])
    try:
        ros.await_mode(STANDBY, 20.0)
        ros.wait(lambda: ros.trigger("arm").success, 10.0)
        with ros.commanding():
            ros.wait(lambda: virtual_rig.live)
            ended_s = time.monotonic()
            parent.send_signal(number)
            grounded_in_time(virtual_rig, ended_s)
    finally:
        parent.kill()
        parent.wait()
    time.sleep(1.0)  # what is under way arrives
    ros.states.clear()
    time.sleep(1.0)
    assert ros.states == []


def test_a_stop_by_service_outlives_a_restart(start_driver, virtual_rig, ros, tmp_path):
    """The next node on the port is in FAULT until somebody clears it."""
    first = start_driver(virtual_rig.port, state_folder=tmp_path)
    ros.await_mode(STANDBY)
    ros.trigger("emergency_stop")
    first.close()
    start_driver(virtual_rig.port, state_folder=tmp_path)
    assert ros.await_mode(FAULT).fault_code == FaultCode.EMERGENCY_STOP
    assert not ros.trigger("arm").success
    ros.wait(lambda: ros.trigger("clear_fault").success)


def test_a_list_of_no_topics_is_none(start_driver, virtual_rig, ros):
    """`-p recorded_topics:=[]` records the state alone, and does not have the node reset its board for ever."""
    driver = start_driver(virtual_rig.port, recorded_topics="[]")
    ros.await_mode(STANDBY)
    driver.arm()


@pytest.mark.parametrize("after_s", [0.1, 0.5, 1.0, 1.5])
def test_ended_while_it_starts(start_driver, ros, after_s):
    """A service manager's stop at any moment of the start: it ends, and without a stack trace."""
    driver = start_driver("/dev/no-such-port")
    time.sleep(after_s)
    driver.process.terminate()
    driver.process.wait(5.0)
    driver.close()
    assert "Traceback" not in "".join(driver.log)


def test_a_parameter_file_that_is_not_there_is_one_sentence():
    """Before anything is opened."""
    command = [
        sys.executable,
        "-m",
        "hasel_driver.nodes.driver_node",
        "--ros-args",
        "--params-file",
        "/no/such.yaml",
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
    assert (done.returncode, "Traceback" in done.stderr, "/no/such.yaml" in done.stderr) == (1, False, True)


def test_a_driver_that_disarms_itself_says_why(start_driver, virtual_rig, ros):
    """In the log and in the state, until it is armed again."""
    driver = start_driver(virtual_rig.port, idle_disarm=1.0)
    driver.arm()
    ros.await_mode(STANDBY)
    expected = "Disarmed by itself, as no command and no experiment came for 1 s: arm again to go on."
    assert (ros.state.fault_code, ros.state.fault_text) == (0, expected)
    ros.wait(lambda: any(expected in line for line in list(driver.log)))
    driver.arm()
    assert ros.await_mode(ARMED).fault_text == ""
