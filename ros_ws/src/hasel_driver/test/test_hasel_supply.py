# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How the board's clock, its test pulse and its replies are judged."""

import random
import re

import pytest
from hasel_driver.protocol import wire
from hasel_driver.protocol.faults import FaultCode, RefusedError, SupplyFaultError
from hasel_driver.protocol.limits import Limits
from hasel_driver.protocol.status import Ground
from hasel_driver.supplies.hasel_supply import DeviceClock, HaselSupply
from hasel_driver.testing.hooks import PUNCTUALITY
from hasel_driver.testing.rig import VIRTUAL_SUPPLY, Bench, Rig


def test_random_delays_are_removed():
    """With delays of up to 20 ms the stamps are right to a millisecond, once a quick line has been seen."""
    clock, generator = DeviceClock(), random.Random(1)
    errors = []
    for index in range(1000):
        device_s = index * 0.01
        arrival_s = 500.0 + device_s + 0.0005 + generator.expovariate(1 / 0.005)
        errors.append(clock.host_time(int(device_s * 1e6), arrival_s) - (500.0 + device_s))
    assert max(map(abs, errors[200:])) < 0.001


def test_follows_a_drifting_resonator():
    """A board 0.5 % fast for ten minutes is followed to better than 100 ms."""
    clock = DeviceClock()
    for index in range(60_000):
        arrival_s = index * 0.01
        stamp_s = clock.host_time(int(arrival_s * 1.005e6), arrival_s)
    assert stamp_s == pytest.approx(arrival_s, abs=0.1)


def test_the_counter_may_overflow():
    """After 71 minutes the board's counter starts again; time goes on."""
    clock = DeviceClock()
    before = clock.host_time(2**32 - 5000, 100.0)
    assert clock.host_time(5000, 100.01) == pytest.approx(before + 0.01)


def test_stamps_increase_and_never_lie_in_the_future():
    """Whatever the delays, stamps keep their order and none is later than its arrival."""
    clock, generator, last = DeviceClock(), random.Random(2), -1.0
    arrival_s = 0.0
    for index in range(500):
        arrival_s = max(arrival_s + 1e-4, index * 0.01 + generator.choice([0.0, 0.001, 0.3]))
        stamp_s = clock.host_time(index * 10_000, arrival_s)
        assert last < stamp_s <= arrival_s
        last = stamp_s


NO_MUSCLE_NF = "0.001"


@pytest.fixture
def bare_rig(rig_command):
    """A supply of each kind with nothing but its own leads on the output."""
    option = ["--capacitance-nf"] if rig_command == VIRTUAL_SUPPLY else []
    rig = Rig([*rig_command, *option, NO_MUSCLE_NF], PUNCTUALITY.note)
    yield rig
    rig.close()


def test_where_no_muscle_is_connected_the_fault_says_so(bare_rig):
    """At arming, and at each clearing that fails; proven it is not, and that is not said."""
    bench = Bench(bare_rig)
    try:
        bench.call(bench.supervisor.arm)
        assert bench.wait_until(lambda: bench.supervisor.fault is not None)
        told = r"saw no load \(upper at most .* µA, lower at most .* µA\): look for a muscle that is not connected"
        assert bench.supervisor.fault.code is FaultCode.NOT_GROUNDED
        assert re.search(told, str(bench.supervisor.fault))
        with pytest.raises(RefusedError, match=told):
            bench.call(bench.supervisor.clear_fault)
        assert Ground.PROVEN not in {status.ground for status in bench.statuses}
    finally:
        bench.close()


def test_where_a_contact_fails_on_a_muscle_nothing_is_said_of_the_load(bench):
    """The muscle drew its current."""
    bench.rig.say("unground")
    bench.call(bench.supervisor.arm)
    assert bench.wait_until(lambda: bench.supervisor.fault is not None)
    assert bench.supervisor.fault.code is FaultCode.NOT_GROUNDED
    assert "no load" not in str(bench.supervisor.fault)


class FakePort:
    """Keeps what is written; gives what a test has put into `answers`."""

    path = "fake"

    def __init__(self) -> None:
        self.written = self.answers = b""

    def write(self, data: bytes) -> None:
        self.written += data

    def read(self) -> bytes:
        data, self.answers = self.answers, b""
        return data


@pytest.fixture
def answer():
    """Gives replies to a supply that has sent ARM and SET VOLTAGE; returns it."""
    port = FakePort()
    supply = HaselSupply(port, Limits(), clock=lambda: 0.0)
    supply.arm()
    supply.set_voltage((3000.0, -2000.0))

    def give(*texts: str) -> HaselSupply:
        port.answers = b"".join(wire.encode(text) for text in texts)
        supply.service(0.0, heartbeat=False)
        return supply

    return give


def test_what_was_asked_may_be_answered(answer):
    """The expected replies are no fault, and each is expected once."""
    supply = answer("<001 OK ARM", "<002 OK VOLTAGE 3000 -2000")
    assert supply.refusal is None
    with pytest.raises(SupplyFaultError, match="not asked here"):
        answer("<002 OK VOLTAGE 3000 -2000")


@pytest.mark.parametrize(
    ("reply", "code"),
    [
        ("<002 ERR SEQUENCE SET VOLTAGE 3000 -2000", FaultCode.SEQUENCE),
        ("<002 ERR SEQUENCE SET VOLTAGE 1000 1000", FaultCode.SEQUENCE),
        ("<001 ERR SEQUENCE ARM", FaultCode.SEQUENCE),
        ("<077 ERR SEQUENCE SET VOLTAGE 1000 1000", FaultCode.SEQUENCE),
        ("<002 ERR SYNTAX SET VOLTAGE 3000 -2000", FaultCode.COMMAND_REFUSED),
        ("<002 ERR UNKNOWN SET VOLTAGE 3000 -2000", FaultCode.COMMAND_REFUSED),
        ("<002 ERR SYNTAX SET VOLTAGE 1000 1000 1000", FaultCode.TWO_MASTERS),
        ("<002 ERR STATE START", FaultCode.TWO_MASTERS),
        ("<002 OK PING", FaultCode.TWO_MASTERS),
        ("<077 OK VOLTAGE 1000 1000", FaultCode.TWO_MASTERS),
        ("<--- ERR CHECKSUM", FaultCode.GARBAGE),
        ("<--- ERR SYNTAX", FaultCode.GARBAGE),
    ],
)
def test_refusals_and_foreign_answers_are_faults(answer, reply, code):
    """A missed command, a second master, a garbled line and a refused command are told apart."""
    with pytest.raises(SupplyFaultError) as raised:
        answer(reply)
    assert raised.value.fault.code is code


def test_a_voltage_that_crosses_a_fault_on_the_line_is_not_one_more(answer):
    """STATE only says that the board has left ARMED; its telemetry tells why."""
    answer("<001 OK ARM", "<002 ERR STATE SET VOLTAGE 3000 -2000")


@pytest.mark.parametrize(
    ("reason", "words"), [("INTERLOCK", "its interlock is open"), ("STATE", "the board answered STATE ARM")]
)
def test_a_refusal_to_arm_is_told(answer, reason, words):
    """Whoever called the service arm learns the reason; nothing is latched."""
    assert answer(f"<001 ERR {reason} ARM").refusal == words
