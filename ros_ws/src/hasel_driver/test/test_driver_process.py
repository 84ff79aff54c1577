"""What happens to the process: killed, frozen, ended, without a port, started after an emergency stop."""

import math
import signal
import time

import pytest
from hasel_driver.faults import FaultCode

STANDBY, ARMED, ACTIVE, FAULT = range(4)
GROUNDED_WITHIN_S = 0.5


def test_killed_node(start_driver, rig, ros):
    """After SIGKILL the supply grounds itself within 500 ms, and the next node does not arm by itself."""
    for _ in range(2):
        driver = start_driver(rig.port)
        driver.arm()
        ros.drive(lambda: rig.live)
        killed_s = time.monotonic()
        driver.process.kill()
        assert rig.await_live(False) - killed_s < GROUNDED_WITHIN_S
    start_driver(rig.port)
    ros.await_mode(STANDBY, 10.0)
    for _ in range(10):
        ros.command((3000.0, -2000.0))
        time.sleep(0.02)
    assert not rig.live


def test_frozen_node(start_driver, virtual_rig, ros):
    """A node that is stopped and goes on later finds itself in FAULT."""
    driver = start_driver(virtual_rig.port)
    driver.arm()
    ros.drive(lambda: virtual_rig.live)
    frozen_s = time.monotonic()
    driver.process.send_signal(signal.SIGSTOP)
    assert virtual_rig.await_live(False) - frozen_s < GROUNDED_WITHIN_S
    driver.process.send_signal(signal.SIGCONT)
    ros.await_mode(FAULT)
    assert not virtual_rig.live


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_ended_node(start_driver, virtual_rig, ros, number):
    """Ctrl-C and a service manager's stop ground at once and end without a stack trace."""
    driver = start_driver(virtual_rig.port)
    driver.arm()
    ros.drive(lambda: virtual_rig.live)
    ended_s = time.monotonic()
    driver.process.send_signal(number)
    assert virtual_rig.await_live(False) - ended_s < 0.25
    assert driver.process.wait(5.0) == 0
    assert "Traceback" not in "".join(driver.log)


def test_pulled_cable(start_driver, virtual_rig, ros, tmp_path):
    """State and diagnostics say that nothing is known; only clear_fault connects again, to STANDBY."""
    link = tmp_path / "supply"
    link.symlink_to(virtual_rig.port)
    driver = start_driver(link)
    driver.arm()
    ros.drive(lambda: virtual_rig.live)
    pulled_s = time.monotonic()
    virtual_rig.say("unplug")
    assert virtual_rig.await_live(False) - pulled_s < GROUNDED_WITHIN_S
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
    for _ in range(2):
        driver = start_driver(virtual_rig.port, discovery_time=1.0)
        state = ros.await_mode(FAULT, 10.0)
        assert state.fault_code == FaultCode.EMERGENCY_STOP
        assert not ros.trigger("arm").success
        assert not ros.trigger("clear_fault").success
        driver.close()
    assert virtual_rig.changes == []
