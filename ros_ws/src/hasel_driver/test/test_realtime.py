"""Real-time priority: granted, or said why not."""

import os
import threading

import pytest
from hasel_driver.realtime import request_realtime


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
