"""What escapes from rclpy's spin, and what becomes of it."""

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

from hasel_recording import spinning
from rclpy._rclpy_pybind11 import RCLError
from rclpy.executors import ExternalShutdownException

ILLEGAL = RCLError("Failed to trigger lifecycle state machine transition: Transition is not registered.")
CONTEXT_GONE = RCLError("failed to initialize wait set: the given context is not valid")


class FakeRclpy:
    """Raises one error after the other from `spin`; `ok` until all but the last `shut` were raised."""

    def __init__(self, errors: list[Exception], shut: int) -> None:
        self.errors, self.shut = errors, shut

    def ok(self) -> bool:
        return len(self.errors) > self.shut

    def spin(self) -> None:
        raise self.errors.pop(0)


@pytest.fixture
def spin(monkeypatch):
    """Spins on errors until shut down; what was reported as an illegal transition."""

    def run(*errors: Exception, shut: int = 0) -> list[Exception]:
        fake, reported = FakeRclpy(list(errors), shut), []
        monkeypatch.setattr(spinning, "rclpy", fake)
        spinning.spin(fake, reported.append)
        return reported

    return run


@pytest.mark.parametrize("last", [CONTEXT_GONE, ExternalShutdownException()])
def test_shutting_down_is_not_an_illegal_transition(spin, last):
    """Ctrl-C, which makes rclpy raise from spin, ends it without a word."""
    assert spin(last) == []


def test_an_illegal_transition_is_told_and_survived(spin):
    """Spinning goes on after each, until the context is shut down."""
    assert spin(ILLEGAL, ILLEGAL, CONTEXT_GONE) == [ILLEGAL, ILLEGAL]


def test_another_error_is_not_called_an_illegal_transition(spin):
    """It ends the node, which disarms on its way out."""
    with pytest.raises(RCLError, match="bad allocation"):
        spin(RCLError("bad allocation"), ILLEGAL)
