# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The thread: real-time priority, and an answer to whatever is asked of it, also when it has ended."""

import os
import threading
import time

import pytest
from hasel_driver.protocol.faults import RefusedError
from hasel_driver.safety.supply_thread import SupplyThread, request_realtime


def test_zero_leaves_it():
    """A priority of nothing asks for nothing."""
    assert "realtime_priority is 0" in request_realtime(0)


def test_it_is_granted_or_the_reason_and_the_remedy_are_told():
    """In a thread of its own, so that the test's is left alone."""
    results = []

    def ask() -> None:
        results.append((request_realtime(10), os.sched_getscheduler(0)))

    thread = threading.Thread(target=ask)
    thread.start()
    thread.join()
    ((problem, policy),) = results
    if problem is None:
        assert policy == os.SCHED_FIFO
    else:
        assert "limits.conf" in problem
    assert os.sched_getscheduler(0) == os.SCHED_OTHER


def test_a_refusal_is_a_sentence(monkeypatch):
    """Where the system does not allow it."""

    def refuse(*_: object) -> None:
        raise PermissionError(1, "Operation not permitted")

    monkeypatch.setattr(os, "sched_setscheduler", refuse)
    assert request_realtime(40).startswith("Operation not permitted: allow it with")
    with pytest.raises(PermissionError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1))


class IdleSupervisor:
    """Nothing happens; `disconnect` waits until a test lets it."""

    armed = False

    def __init__(self) -> None:
        self.may_disconnect = threading.Event()

    def service(self) -> bool:
        return False

    def status(self) -> None:
        return None

    def disconnect(self) -> None:
        self.may_disconnect.wait(5.0)


class NoPort:
    """A supply without a descriptor."""

    def descriptors(self) -> list[int]:
        return []


@pytest.fixture
def thread():
    """A running thread."""
    thread = SupplyThread(IdleSupervisor(), NoPort(), lambda status: None)
    thread.start()
    yield thread
    thread.supervisor.may_disconnect.set()
    thread.stop()


def test_answers_with_result_or_exception(thread):
    """A request's result and its exception come back, a condition is told when it holds or has not held."""
    assert thread.call(lambda: 42).result(timeout=1) == 42
    with pytest.raises(ZeroDivisionError):
        thread.call(lambda: 1 / 0).result(timeout=1)
    assert thread.expect(lambda: True, 1.0).result(timeout=1) is True
    assert thread.expect(lambda: False, 0.05).result(timeout=1) is False


def test_nothing_is_left_waiting_by_a_thread_that_ends(thread):
    """What was asked as it ended, and what is asked afterwards, is refused at once."""
    expected = thread.expect(lambda: False, 60.0)
    ending = threading.Thread(target=thread.stop)
    ending.start()
    time.sleep(0.05)
    asked = thread.call(lambda: 42)
    thread.supervisor.may_disconnect.set()
    ending.join()
    for future in (expected, asked, thread.call(lambda: 42), thread.expect(lambda: True, 1.0)):
        with pytest.raises(RefusedError, match="has ended"):
            future.result(timeout=1)


def test_an_error_while_serving_ends_it_disconnected(thread, monkeypatch):
    """Whatever goes wrong, the supply is disarmed and gets no more heartbeats."""
    monkeypatch.setattr(threading, "excepthook", lambda _: None)
    thread.supervisor.may_disconnect.set()
    thread.supervisor.service = lambda: 1 / 0
    thread.join(timeout=1.0)
    assert not thread.is_alive()
