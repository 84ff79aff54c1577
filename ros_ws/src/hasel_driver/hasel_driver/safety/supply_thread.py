# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Runs a supervisor in a thread of its own, woken by the port and by requests, never held up by the node."""

import concurrent.futures
import contextlib
import os
import queue
import select
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass
from typing import Any, TypeVar

from hasel_driver.protocol.faults import Fault, FaultCode, RefusedError
from hasel_driver.protocol.status import SupplyStatus
from hasel_driver.safety.supervisor import Supervisor
from hasel_driver.supplies.supply import Supply

LOOP_PERIOD_S = 0.01
STATUS_PERIOD_S = 0.1  # when no readings come
HOST_STALL_S = 0.3
LAST_WORD_S = 0.3  # within which the supply should prove its output grounded at the end
ENDED = "The supply's thread has ended: clean up and configure the node."

_T = TypeVar("_T")


def request_realtime(priority: int, thread: int = 0) -> str | None:
    """Schedule a thread (0: the calling one) first in, first out, at `priority` (1 to 99); why not, or None.

    Priority 0 leaves it as it is.
    """
    if priority == 0:
        return "the parameter realtime_priority is 0"
    try:
        os.sched_setscheduler(thread, os.SCHED_FIFO, os.sched_param(priority))
    except (OSError, AttributeError) as error:
        reason = getattr(error, "strerror", None) or "this system has none"
        return (
            f"{reason}: allow it with the line `@realtime - rtprio {priority}` in /etc/security/limits.conf"
            " and a log-in of a user in the group realtime"
        )
    return None


@dataclass(frozen=True)
class _Expectation:
    condition: Callable[[], bool]
    deadline_s: float
    future: Future[bool]


class SupplyThread(threading.Thread):
    """Both are called in this thread: `on_status` for each reading, or every 100 ms, `on_step` once per loop."""

    def __init__(
        self,
        supervisor: Supervisor,
        supply: Supply,
        on_status: Callable[[SupplyStatus], None],
        on_step: Callable[[], None] = lambda: None,
    ) -> None:
        super().__init__(name="supply", daemon=True)
        self.supervisor = supervisor
        self._supply = supply
        self._on_status, self._on_step = on_status, on_step
        self._requests: queue.SimpleQueue[tuple[Callable[[], Any], Future[Any]]] = queue.SimpleQueue()
        self._expectations: list[_Expectation] = []
        self._wake_reader, self._wake_writer = os.pipe()
        os.set_blocking(self._wake_reader, False)
        os.set_blocking(self._wake_writer, False)
        self._host_alive_s: dict[str, float] = {}
        self._stopping = False
        self._ended = threading.Event()
        self._closing = threading.Lock()
        self._status_s = 0.0

    def call(self, request: Callable[[], _T]) -> Future[_T]:
        """Run `request` in this thread as soon as possible; its result or exception is the future's."""
        future: Future[_T] = Future()
        self._requests.put((request, future))
        self._wake()
        if self._ended.is_set():
            self._refuse_requests()
        return future

    def expect(self, condition: Callable[[], bool], timeout_s: float) -> Future[bool]:
        """A future that becomes True once `condition` holds, False after `timeout_s`."""
        future: Future[bool] = Future()
        deadline_s = time.monotonic() + timeout_s
        begun = self.call(lambda: self._expectations.append(_Expectation(condition, deadline_s, future)))

        def refuse(done: Future[None]) -> None:
            if done.exception():
                future.set_exception(done.exception())

        begun.add_done_callback(refuse)
        return future

    def host_is_alive(self, part: str) -> None:
        """To be called by each part of the node; while armed, 300 ms without one of them is a fault."""
        self._host_alive_s[part] = time.monotonic()

    def come_to_rest(self) -> None:
        """Disarm, and have the status told that proves the output grounded, or a fault."""
        with contextlib.suppress(RefusedError, concurrent.futures.TimeoutError):
            self.call(self.supervisor.disarm).result(timeout=LAST_WORD_S)
            if not self.expect(self._at_rest, LAST_WORD_S).result(timeout=2 * LAST_WORD_S):
                unproven = Fault(FaultCode.GROUND_NOT_PROVEN, "the driver ends")
                self.call(lambda: self.supervisor.fail(unproven)).result(timeout=LAST_WORD_S)
            self.call(lambda: self._on_status(self.supervisor.status())).result(timeout=LAST_WORD_S)

    def stop(self) -> None:
        """Disarm, close the port and end."""
        self._stopping = True
        self._wake()
        self.join(timeout=5.0)

    def _at_rest(self) -> bool:
        status = self.supervisor.status()
        proven = status.quiet or not self.supervisor.capabilities.proves_grounded
        return not self.supervisor.connected or (proven and not status.mode.may_be_live)

    def run(self) -> None:
        """The loop; however it ends, the supply is disarmed and its heartbeat ends."""
        try:
            while not self._stopping:
                self._wait()
                self._step()
        finally:
            self.supervisor.disconnect()
            with self._closing:  # nobody writes to a descriptor that is no longer ours
                self._ended.set()
                os.close(self._wake_reader)
                os.close(self._wake_writer)
            self._refuse_requests()
            for expectation in self._expectations:
                expectation.future.set_exception(RefusedError(ENDED))

    def _wake(self) -> None:
        with contextlib.suppress(BlockingIOError), self._closing:  # awake already
            if not self._ended.is_set():
                os.write(self._wake_writer, b"w")

    def _refuse_requests(self) -> None:
        with contextlib.suppress(queue.Empty):
            while True:
                self._requests.get_nowait()[1].set_exception(RefusedError(ENDED))

    def _wait(self) -> None:
        descriptors = [self._wake_reader, *self._supply.descriptors()]
        ready, _, _ = select.select(descriptors, [], [], LOOP_PERIOD_S)
        if self._wake_reader in ready:
            os.read(self._wake_reader, 4096)

    def _step(self) -> None:
        self._run_requests()
        fresh = self.supervisor.service()
        now_s = time.monotonic()
        if self.supervisor.armed:
            self._watch_host(now_s)
        self._on_step()
        self._check_expectations(now_s)
        if fresh or now_s - self._status_s > STATUS_PERIOD_S:
            self._status_s = now_s
            self._on_status(self.supervisor.status())

    def _watch_host(self, now_s: float) -> None:
        for part, alive_s in list(self._host_alive_s.items()):
            if now_s - alive_s > HOST_STALL_S:
                detail = f"no sign of life from its {part} for {now_s - alive_s:.2f} s"
                self.supervisor.fail(Fault(FaultCode.HOST_STALLED, detail))

    def _run_requests(self) -> None:
        while not self._requests.empty():
            request, future = self._requests.get()
            try:
                future.set_result(request())
            except Exception as error:  # noqa: BLE001 — handed to whoever waits for the future
                future.set_exception(error)

    def _check_expectations(self, now_s: float) -> None:
        for expectation in list(self._expectations):
            met = expectation.condition()
            if met or now_s > expectation.deadline_s:
                self._expectations.remove(expectation)
                expectation.future.set_result(met)
