# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""An executor on those workers of a Dask cluster that compute what this process would.

Each worker is asked for its sources and libraries before it gets work; where Dask would wait for ever, it ends with a
sentence.
"""

import asyncio
import inspect
import logging
import pickle
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import CancelledError, Executor, Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache, partial
from typing import Any

from threadpoolctl import threadpool_limits

from hasel_sim import cluster_environment
from hasel_sim.cluster_environment import MISSING, environment
from hasel_sim.errors import ClusterError

JOIN_S = 10.0
"""So long the first worker may take to join a scheduler, and another one to come when all are lost."""

SILENCE_S = 20.0
"""A scheduler that has not answered for so long is given up; one that is busy with a large result answers in a few."""

_STEP_S = 0.05
_START_THEM = "in an environment of this workspace (. setup/environment.bash), of the same revision"


class Members:
    """The workers of a cluster, asked for their sources and libraries as they join; thread-safe."""

    def __init__(self, client: Any, address: str, packages: Sequence[str]) -> None:
        """client: a `distributed.Client` of the scheduler at `address`; packages: whose sources must be the same."""
        self.address, self._client = address, client
        self._own = environment(tuple(packages))
        self._question = _as_text(tuple(packages))
        self._lock = threading.Lock()
        self._asked: set[str] = set()
        self._unlike: dict[str, str | None] = {}
        self._told: set[str] = set()

    @property
    def fitting(self) -> frozenset[str]:
        """Addresses of the workers that may get work."""
        with self._lock:
            return frozenset(worker for worker, unlike in self._unlike.items() if unlike is None)

    def look(self) -> None:
        """Forget who is gone and ask who is new, without waiting for answers; tells of those that do not fit.

        Raises OSError or TimeoutError when the scheduler is gone or silent.
        """
        self._look()
        self._tell()

    def _look(self) -> None:
        present = set(self._client.sync(self._client.scheduler.ncores, callback_timeout=SILENCE_S))
        with self._lock:
            new = present - self._asked
            self._asked = present
            self._unlike = {worker: unlike for worker, unlike in self._unlike.items() if worker in present}
        for worker in new:
            # each by itself: one that hangs would keep the others from being asked
            threading.Thread(target=self._ask, args=(worker,), daemon=True).start()

    def wait(self) -> None:
        """Wait until every worker has answered and one fits, for `JOIN_S` at most; leaves out those that do not.

        Raises ClusterError when there is none that fits.
        """
        end = time.monotonic() + JOIN_S
        while True:
            self._look()
            with self._lock:
                waiting = self._asked - set(self._unlike)
                known = dict(self._unlike)
            if (known and not waiting) or time.monotonic() > end:
                break
            time.sleep(_STEP_S)
        self._tell()
        if None not in known.values():
            raise ClusterError(self._none_fits(known, waiting))

    def _none_fits(self, unlike: Mapping[str, str | None], silent: set[str]) -> str:
        if unlike:
            worker, found = next(iter(unlike.items()))
            return (
                f"none of the workers of {self.address} (there are {len(unlike)}) fits this command: {worker} {found}; "
                f"start them {_START_THEM}"
            )
        if silent:
            return (
                f"{len(silent)} workers of {self.address} have not answered for {JOIN_S:g} s, such as {min(silent)}: "
                "restart them"
            )
        return (
            f"the scheduler at {self.address} has no worker after {JOIN_S:g} s; start one with "
            f"`dask worker {self.address} --nthreads 1` {_START_THEM}"
        )

    def _ask(self, worker: str) -> None:
        found = self._answer(worker)
        if found is None:
            with self._lock:
                self._asked.discard(worker)  # to be asked again, if it is still there
            return
        with self._lock:
            if worker in self._asked:
                self._unlike[worker] = difference(self._own, found)

    def _tell(self) -> None:
        """Say once of every worker why it is left out, where others are not."""
        with self._lock:
            unlike = {worker: found for worker, found in self._unlike.items() if found is not None}
            if len(unlike) == len(self._unlike):
                return
            told, self._told = self._told, self._told | set(unlike)
        for worker in sorted(set(unlike) - told):
            print(
                f"warning: {worker} gets no work: it {unlike[worker]}; start it {_START_THEM}",
                file=sys.stderr,
                flush=True,
            )

    def _answer(self, worker: str) -> dict[str, str] | None:
        try:
            return self._client.run(eval, self._question, workers=[worker])[worker]
        except Exception:  # noqa: BLE001  whatever a worker answers that is going or gone, it is asked again
            return None


def difference(own: Mapping[str, str], found: Mapping[str, str]) -> str | None:
    """What another environment has in place of this one's, for a sentence about it; None where both are the same."""
    unlike = [name for name in own if found.get(name) != own[name]]
    if not unlike:
        return None
    missing = [name for name in unlike if found.get(name, MISSING) == MISSING]
    if missing:
        return f"lacks {', '.join(missing)}; expected {missing[0]} {own[missing[0]]}"
    has = ", ".join(f"{name} {found[name]}" for name in unlike)
    return f"has {has}; expected {', '.join(f'{name} {own[name]}' for name in unlike)}"


def _as_text(packages: tuple[str, ...]) -> str:
    """An expression whose value is the environment where it is evaluated."""
    source = inspect.getsource(cluster_environment)
    return f"(lambda names: exec({source!r}, names) or names['environment']({packages!r}))({{}})"


ANSWER_S = 5.0
"""A scheduler that does not answer for so long when it is first called is none."""

LOSSES = 3
"""So often a task may lose all workers that it was for: as often as Dask begins one anew whose worker died."""

_WATCH_S = 0.5
_LOST = (OSError, TimeoutError, CancelledError, asyncio.TimeoutError, asyncio.CancelledError)
"""What Dask raises where it has lost its scheduler, by the moment at which it notices."""


@contextmanager
def cluster(address: str, packages: Sequence[str]) -> Iterator["ClusterExecutor"]:
    """An executor on those workers of the Dask scheduler at an address that have the same sources of these packages.

    Raises ClusterError when no scheduler answers or no worker fits, and so do its futures when all workers or the
    scheduler are lost.
    """
    from distributed import Client

    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what is lost is told in a sentence here
    logging.getLogger("distributed.client").setLevel(logging.CRITICAL)
    try:
        # in a thread: a notebook's own has a loop; Client would wait for ever for what takes calls and says nothing
        with ThreadPoolExecutor(1) as thread:
            thread.submit(asyncio.run, _answers(address)).result()
        client = Client(address, timeout=ANSWER_S)
    except (*_LOST, TypeError, ValueError) as error:  # TypeError: encrypted, without keys
        raise ClusterError(
            f"no Dask scheduler answers at '{address}' ({str(error) or 'silent'}); expected an address such as "
            "tcp://127.0.0.1:8786: start one with 'dask scheduler'"
        ) from None
    with client:
        members = Members(client, address, packages)
        try:
            members.wait()
        except _LOST:
            raise ClusterError(_gone(address)) from None
        pool = ClusterExecutor(client, members)
        try:
            yield pool
        finally:
            pool.shutdown()


async def _answers(address: str) -> None:
    from distributed.core import rpc

    async with rpc(address, timeout=ANSWER_S) as scheduler:
        await asyncio.wait_for(scheduler.identity(n_workers=0), ANSWER_S)


class _Call:
    """A call that takes place where its pickle is read.

    The scheduler reads what it hands on; it must not have to read models and runs, nor to have this package.
    """

    def __init__(self, call: Callable[[], Any]) -> None:
        self._call = call

    def __reduce__(self) -> tuple[Callable[..., Any], tuple[Any, ...]]:
        return _in_one_thread, (self._call,)


def _in_one_thread(call: Callable[[], Any]) -> Any:
    _one_thread()
    return call()


@cache
def _one_thread() -> None:
    threadpool_limits(1)  # as in processes of this machine


@dataclass(eq=False)
class _Sent:
    payload: bytes = b""
    future: "Future[Any]" = field(default_factory=Future)
    workers: frozenset[str] = frozenset()
    there: Any = None
    """The future of Dask; of one that was sent again, the last."""
    losses: int = 0


class ClusterExecutor(Executor):
    """Calls on the workers that fit. Dask repeats what a lost worker had; here that is told when it cannot.

    resized: called with the number of workers when it changes.
    """

    def __init__(self, client: Any, members: Members) -> None:
        self.resized: Callable[[int], None] = lambda count: None
        self.workers = len(members.fitting)
        self._client, self._members = client, members
        self._lock = threading.Lock()
        self._sent: set[_Sent] = set()
        self._error: ClusterError | None = None
        self._ends = threading.Event()
        threading.Thread(target=self._watch, daemon=True).start()

    def submit(self, function: Callable[..., Any], /, *arguments: Any, **keywords: Any) -> "Future[Any]":
        """A call on one of the workers. Raises ClusterError when they or the scheduler were lost."""
        one = _Sent()
        one.future.set_running_or_notify_cancel()
        try:
            call = _Call(partial(function, *arguments, **keywords))
            one.payload = pickle.dumps(call, pickle.HIGHEST_PROTOCOL)
        except Exception as error:  # noqa: BLE001  handed on by the future, as every executor does
            one.future.set_exception(error)
            return one.future
        with self._lock:
            if self._error is not None:
                raise self._error
            self._sent.add(one)
        self._send(one, self._members.fitting)
        return one.future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Stop watching; what still runs is given up when the client is closed."""
        self._ends.set()

    def _send(self, one: _Sent, workers: frozenset[str]) -> None:
        if not workers:
            return  # whoever joins gets it
        try:
            there = self._client.submit(
                pickle.loads, one.payload, workers=sorted(workers), allow_other_workers=False, pure=False
            )
        except (*_LOST, RuntimeError):
            self._fail(_gone(self._members.address))
            return
        with self._lock:
            one.workers, one.there = workers, there
        there.add_done_callback(partial(self._ended, one))

    def _ended(self, one: _Sent, there: Any) -> None:
        from distributed import KilledWorker

        if one.there is not there:
            return  # it was sent again
        result, error = None, None
        try:
            result = there.result()
        except KilledWorker:
            error = ClusterError(_deadly(self._members.address))
        except (Exception, asyncio.CancelledError) as raised:  # noqa: BLE001  handed on, as every executor does
            if there.status != "error":  # not the task's own
                self._fail(_gone(self._members.address))
                return
            error = raised
        with self._lock:
            if one not in self._sent:
                return
            self._sent.remove(one)
        if error is not None:
            one.future.set_exception(error)
        else:
            one.future.set_result(result)

    def _watch(self) -> None:
        last = time.monotonic()
        while not self._ends.wait(_WATCH_S):
            try:
                self._members.look()
            except (*_LOST, RuntimeError):  # the last, where the client was closed meanwhile
                self._fail(_gone(self._members.address))
                return
            workers = self._members.fitting
            if workers:
                last = time.monotonic()
                self._send_again(workers)
            elif time.monotonic() - last > JOIN_S:
                self._fail(
                    f"all workers of {self._members.address} that fit were lost, {len(self._sent)} tasks are "
                    f"unfinished and none came back within {JOIN_S:g} s: start workers and run the command again"
                )
                return
            if len(workers) != self.workers:
                self.workers = len(workers)
                self.resized(self.workers)

    def _send_again(self, workers: frozenset[str]) -> None:
        """What may only run on workers that are gone, for those that are there now."""
        with self._lock:
            stranded = [one for one in self._sent if not one.workers & workers]
            for one in stranded:
                one.losses += one.there is not None
        if any(one.losses > LOSSES for one in stranded):
            self._fail(_deadly(self._members.address))
            return
        for one in stranded:
            self._send(one, workers)

    def _fail(self, sentence: str) -> None:
        error = ClusterError(sentence)
        with self._lock:
            if self._ends.is_set() or self._error is not None:
                return
            self._error = error
            lost, self._sent = self._sent, set()
        for one in lost:
            one.future.set_exception(error)


def _deadly(address: str) -> str:
    return (
        f"a task was lost with every worker of {address} that began it, perhaps for lack of memory: look at what the "
        "workers said last"
    )


def _gone(address: str) -> str:
    return f"the scheduler at {address} was lost: start it and its workers, and run the command again"
