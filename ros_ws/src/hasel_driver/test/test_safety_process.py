# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The process that talks to the supply, and the node's end of it: each without the other."""

import ctypes
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from hasel_driver.nodes.parameters import PARAMETERS
from hasel_driver.protocol.faults import LimitError, PortError, RefusedError
from hasel_driver.protocol.status import Mode
from hasel_driver.safety.supply_link import SupplyLink

DRIVE_V = (3000.0, -2000.0)
HELD_S = 0.25


@pytest.fixture
def open_link(virtual_rig, tmp_path):
    """Opens links to the virtual supply, with other parameters where they are given."""
    opened = []

    def open_it(**others) -> SupplyLink:
        parameters = {each.name: each.default for each in PARAMETERS}
        own = {"port": virtual_rig.port, "state_folder": str(tmp_path)}
        opened.append(SupplyLink(parameters | own | others, lambda _: None))
        return opened[-1]

    yield open_it
    for link in opened:
        if link.is_alive():
            os.kill(link.process_id, signal.SIGCONT)
        link.stop()


def drive(link: SupplyLink, rig) -> None:
    """Arm, and command until the output is live."""
    link.ask("arm")
    assert link.wait_for(lambda now: now.status.mode is Mode.ARMED, 2.0), link.now.status
    end_s = time.monotonic() + 2.0
    voltage_v = (0.0, 0.0)
    while not rig.live and time.monotonic() < end_s:
        link.tell("host_is_alive", "test")
        link.tell("command", voltage_v, time.monotonic())
        voltage_v = DRIVE_V
        time.sleep(0.01)
    assert rig.live


def test_what_is_asked_is_known_when_it_is_answered(open_link, virtual_rig):
    """The state that follows from a request is there with its answer, and its refusal is the supply's own."""
    link = open_link()
    assert link.wait_for(lambda now: now.status.mode is Mode.STANDBY, 2.0)
    link.ask("arm")
    assert link.now.armed
    link.ask("disarm")
    assert not link.now.armed
    with pytest.raises(RefusedError, match="There is no fault to clear"):
        link.ask("clear_fault")


def test_a_held_interpreter_lock_does_not_hold_up_the_heartbeat(open_link, virtual_rig):
    """What the node computes for a quarter of a second costs a command its time, and no fault."""
    link = open_link()
    drive(link, virtual_rig)
    ctypes.PyDLL(None).usleep(int(HELD_S * 1e6))  # which, unlike CDLL, keeps the lock
    link.tell("host_is_alive", "test")
    assert link.wait_for(lambda now: not now.status.mode.may_be_live or now.status.mode is Mode.ARMED, 1.0)
    assert (link.now.status.fault, link.now.status.mode) == (None, Mode.ARMED)


def test_a_command_that_was_held_up_on_its_way_is_too_old(open_link, virtual_rig):
    """What lay before a process that stood still for a quarter of a second is not obeyed when it goes on."""
    link = open_link(heartbeat_timeout=0.42)
    link.ask("arm")
    assert link.wait_for(lambda now: now.status.mode is Mode.ARMED, 2.0), link.now.status
    link.ask("command", (0.0, 0.0), time.monotonic())  # taken before the process stands still
    rejected = link.now.rejected_commands
    os.kill(link.process_id, signal.SIGSTOP)
    link.tell("command", DRIVE_V, time.monotonic())
    time.sleep(0.3)
    os.kill(link.process_id, signal.SIGCONT)
    assert link.wait_for(lambda now: now.rejected_commands == rejected + 1, 1.0), link.now
    assert not virtual_rig.live


@pytest.mark.rounds(3, 30)
def test_the_board_is_grounded_when_the_process_is_killed(open_link, virtual_rig, grounded_in_time, rounds):
    """The board grounds itself, the node no longer knows its output, and every request is refused."""
    for _ in range(rounds):
        link = open_link()
        drive(link, virtual_rig)
        killed_s = time.monotonic()
        os.kill(link.process_id, signal.SIGKILL)
        grounded_in_time(virtual_rig, killed_s)
        assert link.now.status.output == "unknown"
        assert not link.is_alive()
        with pytest.raises(RefusedError, match="has ended"):
            link.ask("disarm")


def test_a_process_that_stands_still_is_not_believed(open_link, virtual_rig, grounded_in_time):
    """Its last word is no longer the state; the board has grounded itself."""
    link = open_link()
    drive(link, virtual_rig)
    frozen_s = time.monotonic()
    os.kill(link.process_id, signal.SIGSTOP)
    grounded_in_time(virtual_rig, frozen_s)
    time.sleep(max(0.0, frozen_s + 0.6 - time.monotonic()))
    assert (link.now.status.output, link.now.status.mode) == ("unknown", Mode.FAULT)
    with pytest.raises(RefusedError, match="did not answer within"):
        link.ask("disarm", timeout_s=0.1)


def test_a_killed_node_leaves_neither_voltage_nor_process(virtual_rig, tmp_path, grounded_in_time):
    """The end of the socket is enough."""
    script = f"""
import time
from hasel_driver.nodes.parameters import PARAMETERS
from hasel_driver.safety.supply_link import SupplyLink
chosen = {{each.name: each.default for each in PARAMETERS}}
link = SupplyLink(chosen | {{"port": {virtual_rig.port!r}, "state_folder": {str(tmp_path)!r}}}, lambda _: None)
print(link.process_id, flush=True)
link.ask("arm")
link.wait_for(lambda now: now.status.mode.name == "ARMED", 2.0)
voltage_v = (0.0, 0.0)
while True:
    link.tell("host_is_alive", "test")
    link.tell("command", voltage_v, time.monotonic())
    voltage_v = {DRIVE_V!r}
    time.sleep(0.01)
"""
    with subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True) as node:
        assert node.stdout is not None
        child = int(node.stdout.readline())
        virtual_rig.await_live(True)
        killed_s = time.monotonic()
        node.kill()
        grounded_in_time(virtual_rig, killed_s)
    end_s = time.monotonic() + 3.0
    entry = Path("/proc") / str(child)
    while entry.exists() and time.monotonic() < end_s:
        time.sleep(0.01)
    assert not entry.exists()


def test_what_keeps_the_supply_from_opening_is_raised_in_the_node(open_link):
    """A port that is not there, and limits that contradict each other, in the sentence of the process."""
    with pytest.raises(PortError, match="/nowhere"):
        open_link(port="/nowhere")
    with pytest.raises(LimitError, match="second_port"):
        open_link(backend="shvps")


def test_the_process_imports_no_ros():
    """What talks to the supply starts quickly, and waits for nothing that the node's middleware does."""
    program = "import sys, hasel_driver.safety.safety_process; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    packages = {name.split(".")[0] for name in done.stdout.split()}
    assert not packages & {"rclpy", "hasel_interfaces", "hasel_recording", "numpy", "yaml"}
    others = [name for name in done.stdout.split() if name.startswith("hasel_driver.")]
    assert not [name for name in others if name.split(".")[1] not in ("protocol", "supplies", "safety")]
