# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The node with the backend shvps, on two emulated boards: what it refuses, drives, and does not claim."""

import threading

import pytest
from hasel_driver.protocol.faults import FaultCode
from hasel_driver.virtual.pseudo_terminal import PseudoTerminal
from hasel_driver.virtual.virtual_shvps import VirtualShvps, serve

STANDBY, ARMED, ACTIVE, FAULT = range(4)
UNPROVEN = "this kind cannot prove its output grounded"


@pytest.fixture
def boards():
    """Two emulated boards, upper and lower, and the names of their ports."""
    boards, ports = (VirtualShvps(), VirtualShvps()), (PseudoTerminal(), PseudoTerminal())
    ended = threading.Event()
    for board, port in zip(boards, ports, strict=True):
        threading.Thread(target=serve, args=(board, port, lambda: not ended.is_set()), daemon=True).start()
    yield boards, {"port": ports[0].path, "second_port": ports[1].path}
    ended.set()


def test_needs_consent_drives_and_claims_nothing(boards, start_driver, ros):
    """Arming needs accept_no_deadman; voltages are clipped to one polarity; a stop does not say grounded."""
    (upper, lower), ports = boards
    driver = start_driver(**ports, backend="shvps", accept_no_deadman=True, maximum_voltage=4000.0)
    driver.arm()

    def driven_and_told() -> bool:
        return upper.muscle.voltage_v > 3900 and ros.state.commanded_voltage.tolist() == [4000.0, 0.0]

    ros.drive(driven_and_told, (9000.0, -500.0))
    answer = ros.trigger("emergency_stop")
    assert (answer.success, UNPROVEN in answer.message) == (False, True)
    state = ros.await_mode(FAULT)
    assert state.fault_code == FaultCode.EMERGENCY_STOP
    assert "Nothing proves the output grounded" in state.fault_text
    assert [board.values[name] for board in (upper, lower) for name in ("SwMode", "Vset")] == [0, 0, 0, 0]
    assert not ros.trigger("arm").success
    assert ros.trigger("clear_fault").success
    ros.await_mode(STANDBY)


def test_is_not_armed_without_consent(boards, start_driver, ros):
    """A supply that stays live when its host dies is refused, with the parameter's name."""
    (upper, _), ports = boards
    start_driver(**ports, backend="shvps")
    ros.await_mode(STANDBY)
    ros.wait(lambda: "accept_no_deadman" in ros.trigger("arm").message)
    assert upper.values["SwMode"] == 0


def test_needs_both_ports(start_driver, ros):
    """One port alone is refused in one sentence."""
    driver = start_driver("/dev/null", backend="shvps")
    ros.wait(lambda: any("set `second_port`" in line for line in driver.log), 10.0)
    assert "Traceback" not in "".join(driver.log)
