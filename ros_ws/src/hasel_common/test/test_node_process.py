# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The exit codes of a process around a node."""

import signal

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")

import rclpy
from hasel_common.node_process import run_node

CUT_SHORT = "Unable to convert call argument '0' to Python object"


@pytest.fixture(autouse=True)
def own_signals():
    """`run_node` leaves Ctrl-C ignored, as its process is about to end."""
    usual = signal.getsignal(signal.SIGINT)
    yield
    signal.signal(signal.SIGINT, usual)


def node():
    """One that does nothing."""
    return rclpy.create_node("quiet")


def test_ctrl_c_in_the_middle_of_a_message_is_a_quiet_end():
    """The context is gone by then, and pybind11 raises an error of its own."""

    def spin(_) -> None:
        rclpy.shutdown()
        raise RuntimeError(CUT_SHORT)

    assert run_node(node, spin) == 0


def test_an_error_while_nobody_ended_it_escapes():
    """And the context is shut down on the way out."""

    def spin(_) -> None:
        raise RuntimeError(CUT_SHORT)

    with pytest.raises(RuntimeError, match="Unable to convert"):
        run_node(node, spin)
    assert not rclpy.ok()


def test_ctrl_c_is_a_quiet_end():
    """As Python tells it."""

    def spin(_) -> None:
        raise KeyboardInterrupt

    assert run_node(node, spin) == 0


def test_what_is_wrong_is_said_in_a_sentence(capsys):
    """On standard error, with an exit code that is not zero."""

    def make():
        raise LookupError("found no such model; expected swimmer")

    assert run_node(make, errors=(LookupError,)) == 1
    assert capsys.readouterr().err == "error: found no such model; expected swimmer\n"
