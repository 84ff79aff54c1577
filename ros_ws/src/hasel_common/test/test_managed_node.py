# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Nodes with a lifecycle: states, failures, illegal transitions; what escapes from rclpy's spin."""

import threading

import pytest

pytest.importorskip("rclpy", reason="ROS 2 is not there")
import sys
import time

import rclpy
from hasel_common import managed_node
from hasel_common.managed_node import ManagedNode, Return, start_and_spin
from hasel_common.node_parameter import AUTOSTART
from rclpy._rclpy_pybind11 import InvalidHandle, RCLError
from rclpy.executors import ExternalShutdownException


class Lamp(ManagedNode):
    """Notes what it is told; its bulb may be missing."""

    expected_errors = (ValueError,)

    def __init__(self, autostart: bool = True) -> None:
        super().__init__("lamp")
        self.declare_parameter(AUTOSTART[0], autostart)
        self.done: list[str] = []
        self.bulb = True

    def configure(self) -> None:
        if not self.bulb:
            raise ValueError("there is no bulb: put one in")
        self.done.append("configure")

    def activate(self) -> None:
        self.done.append("activate")

    def deactivate(self) -> None:
        self.done.append("deactivate")

    def cleanup(self) -> None:
        self.done.append("cleanup")


@pytest.fixture
def lamp():
    """A lamp in a context of its own."""
    rclpy.init()
    lamp = Lamp()
    yield lamp
    lamp.destroy_node()
    rclpy.try_shutdown()


def test_it_begins_rests_and_begins_again(lamp):
    """Each transition calls its own method; `active` tells whether it is at work."""
    lamp.begin()
    assert lamp.active
    assert lamp.trigger_deactivate() == Return.SUCCESS
    assert not lamp.active
    assert lamp.trigger_activate() == Return.SUCCESS
    assert lamp.trigger_shutdown() == Return.SUCCESS
    assert lamp.done == ["configure", "activate", "deactivate", "activate", "deactivate", "cleanup"]


def test_what_cannot_be_configured_says_why_and_may_be_tried_again(lamp):
    """`begin` raises it; the transition fails and the node stays as it was."""
    lamp.bulb = False
    with pytest.raises(ValueError, match="there is no bulb"):
        lamp.begin()
    assert lamp.trigger_configure() == Return.FAILURE
    lamp.bulb = True
    lamp.begin()
    assert lamp.active


def test_an_illegal_transition_ends_nothing(lamp):
    """Asked for over ROS, rclpy lets it escape from spin."""
    from lifecycle_msgs.msg import Transition
    from lifecycle_msgs.srv import ChangeState

    thread = threading.Thread(target=start_and_spin, args=(lamp,), daemon=True)
    thread.start()
    user = rclpy.create_node("user")
    client = user.create_client(ChangeState, "/lamp/change_state")
    assert client.wait_for_service(timeout_sec=60.0)

    def ask(transition: int):
        future = client.call_async(ChangeState.Request(transition=Transition(id=transition)))
        rclpy.spin_until_future_complete(user, future, timeout_sec=2.0)
        return future

    ask(Transition.TRANSITION_CLEANUP)  # illegal while active: nobody answers
    answer = ask(Transition.TRANSITION_DEACTIVATE)
    rclpy.spin_until_future_complete(user, answer, timeout_sec=60.0)
    assert answer.result().success
    user.destroy_node()
    rclpy.try_shutdown()
    thread.join(timeout=60.0)
    assert not thread.is_alive()


ILLEGAL = RCLError("Failed to trigger lifecycle state machine transition: Transition is not registered.")
CUT_SHORT = RuntimeError("Unable to convert call argument '0' to Python object")
CONTEXT_GONE = RCLError("failed to initialize wait set: the given context is not valid")


class FakeRclpy:
    """Raises one error after the other from `spin`; `ok` until all but the last `shut` were raised."""

    def __init__(self, errors: list[Exception], shut: int) -> None:
        self.errors, self.shut = errors, shut

    def ok(self, context=None) -> bool:
        return len(self.errors) > self.shut

    def spin(self) -> None:
        raise self.errors.pop(0)


@pytest.fixture
def spin(monkeypatch):
    """Spins on errors until shut down; what was reported as an illegal transition."""

    def run(*errors: Exception, shut: int = 0) -> list[Exception]:
        fake, reported = FakeRclpy(list(errors), shut), []
        monkeypatch.setattr(managed_node, "rclpy", fake)
        managed_node.spin(fake, reported.append)
        return reported

    return run


@pytest.mark.parametrize("last", [CONTEXT_GONE, CUT_SHORT, ExternalShutdownException()])
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


@pytest.fixture
def failures(monkeypatch):
    """What threads ended with, which take turns often here."""
    found, usual = [], sys.getswitchinterval()
    monkeypatch.setattr(threading, "excepthook", lambda failure: found.append(failure.exc_value))
    sys.setswitchinterval(1e-6)
    yield found
    sys.setswitchinterval(usual)


def busy_node():
    """A node with much to look through all the time: rclpy's executor, shut down meanwhile, fails one time in ten."""
    node = managed_node.node_alone("busy")
    for number in range(60):
        node.create_timer(100.0 if number else 1e-4, lambda: None)
    return node


def test_a_thread_that_is_busy_ends_without_a_failure(failures):
    """Again and again, in the middle of whatever rclpy does."""
    for _ in range(40):
        node = busy_node()
        spun = managed_node.BackgroundSpin(node, "busy", owns_context=True)
        time.sleep(0.003)
        spun.close()
        assert not node.context.ok()
    assert failures == []


def test_a_thread_that_waits_ends_at_once():
    """Nothing has to come in for it to notice, and closing again does nothing."""
    spun = managed_node.BackgroundSpin(managed_node.node_alone("idle"), "idle", owns_context=True)
    time.sleep(0.05)
    begun = time.monotonic()
    spun.end()
    spun.close()
    assert time.monotonic() - begun < managed_node.PATIENCE_S
    assert "idle" not in {thread.name for thread in threading.enumerate()}


def test_a_callback_comes_to_its_end_before_the_node_goes():
    """Whoever closes waits for it."""
    node = managed_node.node_alone("slow")
    begun, done = threading.Event(), threading.Event()

    def work():
        begun.set()
        time.sleep(0.2)
        done.set()

    node.create_timer(1e-3, work)
    spun = managed_node.BackgroundSpin(node, "slow", owns_context=True)
    assert begun.wait(20.0)
    spun.close()
    assert done.is_set()


def test_what_is_called_first_is_called_in_the_thread():
    """Such as a thread's own priority."""
    called = []
    spun = managed_node.BackgroundSpin(
        managed_node.node_alone("first"),
        "first",
        begin=lambda: called.append(threading.current_thread().name),
        owns_context=True,
    )
    spun.close()
    assert called == ["first"]


def test_a_context_that_was_shut_down_ends_the_thread_quietly(failures):
    """As Ctrl-C does; closing is then no error either."""
    node = busy_node()
    spun = managed_node.BackgroundSpin(node, "busy")
    node.context.try_shutdown()
    spun.close()
    assert failures == []


def test_a_publisher_that_another_thread_destroys_does_not_end_the_spinning(monkeypatch):
    """The executor finds a handle that is gone in its wait set now and then; the spin goes on without it."""
    spin_once, gone = (
        managed_node.SingleThreadedExecutor.spin_once,
        [InvalidHandle("destruction was requested")],
    )
    monkeypatch.setattr(
        managed_node.SingleThreadedExecutor,
        "spin_once",
        lambda self: (_ for _ in ()).throw(gone.pop()) if gone else spin_once(self),
    )
    node = managed_node.node_alone("spun")
    beats = []
    node.create_timer(0.01, lambda: beats.append(time.monotonic()))
    spun = managed_node.BackgroundSpin(node, "spun", owns_context=True)
    try:
        time.sleep(0.3)
    finally:
        spun.close()
    assert (gone, len(beats) > 3) == ([], True)
