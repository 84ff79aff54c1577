# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The hand tool: by lines from a pipe, and by keys of a terminal."""

import os
import pty
import signal
import subprocess
import sys
import time
from contextlib import suppress
from itertools import pairwise

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")
pytest.importorskip("hasel_interfaces", reason="the workspace is not built")

from hasel_driver.protocol.faults import FaultCode
from hasel_driver.protocol.status import Mode
from hasel_driver.tools.console import ramp

CONSOLE = [sys.executable, "-c", "from hasel_driver.start import console; raise SystemExit(console())"]


def test_a_ramp_is_straight_and_keeps_its_rate():
    """Both voltages arrive together, none moves faster than the rate, and the end is exact."""
    values = list(ramp((0.0, 0.0), (3000.0, -1000.0), 1000.0, 0.1))
    assert values[-1] == (3000.0, -1000.0)
    assert max(abs(b[0] - a[0]) for a, b in pairwise(values)) == pytest.approx(100.0)
    assert all(upper == pytest.approx(-3 * lower) for upper, lower in values)


def test_a_script_arms_ramps_and_disarms(start_driver, virtual_rig, ros):
    """Without the ros2 command line: the output reaches its voltage and comes back, and is grounded at the end."""
    start_driver(virtual_rig.port)
    ros.await_mode(Mode.STANDBY)
    time.sleep(0.3)
    lines = "arm\nlimit 2500\nrate 5000\nramp 2000 -1000 0.3\nfly\nramp nowhere 0 1\nstate\nquit\n"
    with ros.silent():
        done = subprocess.run(CONSOLE, input=lines, capture_output=True, text=True, timeout=60)
    assert done.returncode == 0, done.stderr
    for words in ("Armed", "The limit is 2500 V", "ANY KEY STOPS", "'fly' is not understood", "is no number"):
        assert words in done.stdout
    assert "Disarmed. The " in done.stdout
    peaks = virtual_rig.ask("output")[4:]
    assert peaks == pytest.approx([2000.0, 1000.0], abs=20)
    assert ros.await_mode(Mode.STANDBY).maximum_voltage == 2500.0


def test_another_namespace_is_reached(virtual_rig, ros, tmp_path):
    """The console of a second rig arms that one."""
    driver = [sys.executable, "-m", "hasel_driver.nodes.driver_node", "--ros-args", "-r", "__ns:=/rig2"]
    for word in (f"port:={virtual_rig.port}", "discovery_time:=0.0", f"state_folder:={tmp_path}"):
        driver += ["-p", word]
    console = [*CONSOLE, "--namespace", "/rig2"]
    with subprocess.Popen([*driver, "-p", f"history_file:={tmp_path}/history.jsonl"]) as process:
        try:
            ros.wait(lambda: ros.node.count_publishers("/rig2/state") == 1, 20.0)
            done = subprocess.run(
                console, input="arm\narm\narm\nquit\n", capture_output=True, text=True, timeout=60
            )
        finally:
            process.terminate()
    assert "Armed, 0 V." in done.stdout


def test_any_key_stops(start_driver, virtual_rig, ros, grounded_in_time):
    """A key pressed while the voltage is on grounds it, and it stays off."""
    start_driver(virtual_rig.port)
    ros.await_mode(Mode.STANDBY)
    time.sleep(0.3)
    here, there = pty.openpty()
    process = subprocess.Popen(CONSOLE, stdin=there, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        with ros.silent():
            os.write(here, b"arm\n")
            ros.await_mode(Mode.ARMED, 20.0)
            os.write(here, b"ramp 3000 0\n")
            ros.wait(lambda: virtual_rig.live, 10.0)
            time.sleep(0.3)
            pressed_s = time.monotonic()
            os.write(here, b"x")
            grounded_in_time(virtual_rig, pressed_s)
            assert ros.await_mode(Mode.FAULT).fault_code == FaultCode.EMERGENCY_STOP
        for _ in range(20):  # what is typed before its prompt is lost
            os.write(here, b"quit\n")
            with suppress(subprocess.TimeoutExpired):
                process.wait(0.5)
                break
        assert process.returncode == 0
    finally:
        process.kill()
        process.wait()
        os.close(here)
        os.close(there)


def test_a_console_that_is_ended_grounds_what_it_armed(start_driver, virtual_rig, ros, grounded_in_time):
    """Its terminal is closed while the voltage is on: nobody is left who could press a key."""
    start_driver(virtual_rig.port)
    ros.await_mode(Mode.STANDBY)
    time.sleep(0.3)
    here, there = pty.openpty()
    process = subprocess.Popen(CONSOLE, stdin=there, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    try:
        with ros.silent():
            os.write(here, b"arm\n")
            ros.await_mode(Mode.ARMED, 20.0)
            os.write(here, b"ramp 3000 0\n")
            ros.wait(lambda: virtual_rig.live, 10.0)
            time.sleep(0.3)
            ended_s = time.monotonic()
            process.send_signal(signal.SIGHUP)
            grounded_in_time(virtual_rig, ended_s)
            ros.wait(lambda: ros.state.mode in (Mode.FAULT, Mode.STANDBY))
            assert process.wait(10.0) == 0
    finally:
        process.kill()
        process.wait()
        os.close(here)
        os.close(there)


def test_a_stop_is_sent_though_two_answer(start_driver, virtual_rig, ros, tmp_path):
    """Nobody can say whose answer it is, but the supply is stopped; to arm is not even asked for."""
    from hasel_driver.testing.ros_client import another_node
    from std_srvs.srv import Trigger

    start_driver(virtual_rig.port)
    ros.await_mode(Mode.STANDBY)
    said = tmp_path / "said.txt"
    with another_node("stranger") as node, said.open("w") as out, ros.silent():
        for name in ("/hasel/emergency_stop", "/hasel/arm"):
            node.create_service(Trigger, name, lambda _, response: response)
        process = subprocess.Popen(CONSOLE, stdin=subprocess.PIPE, stdout=out, text=True)
        try:
            for line, words in (
                ("arm", "2 nodes answer arm"),
                ("stop", "sent, but 2 nodes answer emergency_stop"),
            ):
                end_s = time.monotonic() + 20.0  # until the console has found the stranger, too
                while words not in said.read_text() and time.monotonic() < end_s:
                    process.stdin.write(f"{line}\n")
                    process.stdin.flush()
                    time.sleep(0.5)
                assert words in said.read_text()
            ros.wait(lambda: ros.state.fault_code == FaultCode.EMERGENCY_STOP)
        finally:
            process.kill()
            process.wait()
