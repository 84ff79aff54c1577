# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The SHVPS backend against an emulation of that board's command set."""

import math
import threading
import time

import pytest
from hasel_driver.protocol.faults import FaultCode, PortError
from hasel_driver.protocol.limits import Limits
from hasel_driver.protocol.status import Mode
from hasel_driver.safety.supervisor import Supervisor
from hasel_driver.supplies.serial_port import SerialPort
from hasel_driver.supplies.shvps import ShvpsSupply
from hasel_driver.virtual.pseudo_terminal import PseudoTerminal
from hasel_driver.virtual.virtual_shvps import VirtualShvps, serve


class Pair:
    """Two emulated boards and a supervisor on them."""

    def __init__(self) -> None:
        self.boards = (VirtualShvps(), VirtualShvps())
        self.ports = (PseudoTerminal(), PseudoTerminal())
        self.serving = [True, True]
        for index in range(2):
            threading.Thread(target=self._serve, args=(index,), daemon=True).start()
        hosts = tuple(SerialPort(port.path) for port in self.ports)
        self.supervisor = Supervisor(ShvpsSupply(hosts, Limits(maximum_voltage_v=4000.0)), time.monotonic)

    def _serve(self, index: int) -> None:
        serve(self.boards[index], self.ports[index], lambda: self.serving[index])

    def run(self, duration_s: float, voltage: tuple[float, float] | None = None) -> None:
        """Service the supply, commanding a voltage."""
        end_s = time.monotonic() + duration_s
        while time.monotonic() < end_s:
            if voltage is not None:
                self.supervisor.command((0.0, 0.0))  # with which every controller begins
                self.supervisor.command(voltage)
            self.supervisor.service()
            time.sleep(0.002)


@pytest.fixture
def pair():
    """Two boards, connected."""
    pair = Pair()
    pair.supervisor.connect()
    yield pair
    pair.supervisor.disconnect()
    pair.serving[:] = [False, False]


def test_arms_drives_both_boards_and_disarms(pair):
    """Set-points reach each muscle's board, clipped to the limit and to one polarity, and are read back."""
    pair.run(0.1)
    assert pair.supervisor.status().mode is Mode.STANDBY
    pair.supervisor.arm()
    pair.run(0.1)
    assert pair.supervisor.status().mode is Mode.ARMED
    pair.run(0.5, (9000.0, -500.0))
    status = pair.supervisor.status()
    assert (status.mode, status.commanded_v) == (Mode.ACTIVE, (4000.0, 0.0))
    assert status.measured_v == pytest.approx((4000.0, 0.0), abs=5)
    assert all(math.isnan(current) for current in status.current_a)
    pair.supervisor.disarm()
    pair.run(0.1)
    assert [board.values["SwMode"] for board in pair.boards] == [0, 0]
    assert pair.supervisor.status().mode is Mode.STANDBY


def test_never_claims_a_grounded_output(pair):
    """The command set cannot tell, so neither does the state: a switched-off muscle keeps its charge."""
    pair.supervisor.arm()
    pair.run(0.1)
    pair.run(0.3, (3000.0, 3000.0))
    pair.supervisor.disarm()
    pair.run(0.1)
    assert pair.boards[0].muscle.voltage_v > 1000
    assert pair.supervisor.status().output == "unknown"


def test_commands_expire(pair):
    """200 ms after the last command both set-points are zero."""
    pair.supervisor.arm()
    pair.run(0.1)
    pair.run(0.2, (3000.0, 3000.0))
    pair.run(0.35)
    assert [board.values["Vset"] for board in pair.boards] == [0, 0]
    assert pair.supervisor.status().mode is Mode.ARMED


def test_one_board_gone_switches_the_other_off(pair):
    """Losing one board is a fault of the whole supply."""
    pair.supervisor.arm()
    pair.run(0.1)
    pair.run(0.2, (3000.0, 3000.0))
    pair.serving[1] = False
    pair.run(0.4, (3000.0, 3000.0))
    assert pair.supervisor.fault.code in (FaultCode.NO_REPLY, FaultCode.NO_TELEMETRY)
    assert (pair.boards[0].values["SwMode"], pair.boards[0].values["Vset"]) == (0, 0)


def test_a_board_that_switches_itself_off_is_a_fault(pair):
    """A reset board is found by its switch mode, and is not armed again."""
    pair.supervisor.arm()
    pair.run(0.4)
    for board in pair.boards:
        board.values.update(SwMode=0, Vset=0)
    pair.run(0.2)
    assert pair.supervisor.fault.code is FaultCode.UNEXPECTED_STATE
    assert [board.values["SwMode"] for board in pair.boards] == [0, 0]


def test_something_else_on_the_port_is_refused():
    """A device that does not answer QVer as an SHVPS does is named in one sentence."""
    silent, other = PseudoTerminal(), PseudoTerminal()
    supply = ShvpsSupply((SerialPort(silent.path), SerialPort(other.path)), Limits())
    with pytest.raises(PortError, match="No SHVPS answered QVer"):
        supply.open()


@pytest.mark.parametrize(
    ("command", "answer"),
    [
        (b"SVset 1200\r", b"1200\r\n"),
        (b"SVset 99999\r", b"5000\r\n"),
        (b"QVmax\r", b"5000\r\n"),
        (b"SSwMode 1\r", b"1\r\n"),
        (b"QVer\r", b"slave 5\r\n"),
        (b"SVset high\r", b"Err\r\n"),
        (b"svset 1\r", b"Err\r\n"),
        (b"Nonsense\r", b"Err\r\n"),
    ],
)
def test_emulation_answers_as_the_published_firmware(command, answer):
    """Every command returns one value, clamped; names are case-sensitive; the unknown is Err."""
    assert VirtualShvps().receive(command) == answer
