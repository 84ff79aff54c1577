"""How replies are judged: each refusal under the fault that its reason means, and answers to others found."""

import pytest
from hasel_driver import protocol
from hasel_driver.faults import FaultCode, SupplyFaultError
from hasel_driver.hasel_supply import HaselSupply
from hasel_driver.limits import Limits


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
        port.answers = b"".join(protocol.encode(text) for text in texts)
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
