# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Many simulations at once, on this machine's cores or on a Dask cluster, by one code path."""

import multiprocessing
import os
import threading
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import (
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
)
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import count, pairwise, product
from numbers import Integral
from typing import Any, ParamSpec, TypeVar

from threadpoolctl import threadpool_limits

from hasel_sim.cluster import cluster
from hasel_sim.errors import HaselSimError, SimulationError
from hasel_sim.model import Model
from hasel_sim.run import Run, Simulation
from hasel_sim.simd import LANES
from hasel_sim.simulate import ModelKind, kind_of, simulate_many

_ASKED = 0
_Given = ParamSpec("_Given")
Result = TypeVar("Result")


@dataclass(eq=False)
class Turn:
    """A place in the order of a `Turns`, the first ones first."""

    place: int = _ASKED


@dataclass(frozen=True, eq=False)
class _Task:
    turn: Turn
    call: Callable[[], Any]
    future: "Future[Any]" = field(default_factory=Future)


class Turns(Executor):
    """Hands tasks on as soon as a process is free for them, in the order of their turns.

    What is only foreseen leaves one process free: a task is never broken off, and what is asked for in many small steps
    would wait for a long one every time.
    """

    def __init__(self, pool: Executor, workers: int) -> None:
        """workers: how many tasks the executor works on at once; nothing is foreseen by one."""
        self.workers, self._pool = workers, pool
        self._lock, self._of_thread = threading.Lock(), threading.local()
        self._waiting: list[_Task] = []
        self._running: list[_Task] = []
        self._places = count(_ASKED + 1)

    def submit(
        self, function: Callable[_Given, Result], /, *arguments: _Given.args, **keywords: _Given.kwargs
    ) -> "Future[Result]":
        """A task in the turn of this thread."""
        turn = getattr(self._of_thread, "turn", None) or Turn()
        task = _Task(turn, partial(function, *arguments, **keywords))
        with self._lock:
            self._waiting.append(task)
        self._hand_on()
        return task.future

    def foreseen(self) -> Turn:
        """A turn behind all others so far, for what nobody asks for yet."""
        return Turn(next(self._places))

    @contextmanager
    def within(self, turn: Turn) -> Iterator[None]:
        """What this thread submits meanwhile is in that turn."""
        before = getattr(self._of_thread, "turn", None)
        self._of_thread.turn = turn
        try:
            yield
        finally:
            self._of_thread.turn = before

    def ask(self, turn: Turn) -> None:
        """Somebody waits for it: it goes before all that is only foreseen."""
        with self._lock:
            turn.place = _ASKED
        self._hand_on()

    def resize(self, workers: int) -> None:
        """The executor works on so many tasks at once from now on."""
        with self._lock:
            self.workers = workers
        self._hand_on()

    def _hand_on(self) -> None:
        while (task := self._next()) is not None:
            if not task.future.set_running_or_notify_cancel():
                self._ended(task)
                continue
            try:
                self._pool.submit(task.call).add_done_callback(partial(self._done, task))
            except RuntimeError as error:  # what an executor that is broken or shut down raises
                self._ended(task)
                task.future.set_exception(error)

    def _next(self) -> _Task | None:
        """The task that is to be begun now."""
        with self._lock:
            foreseen = sum(task.turn.place > _ASKED for task in self._running)
            able = [t for t in self._waiting if t.turn.place == _ASKED or foreseen < self.workers - 1]
            if len(self._running) >= self.workers or not able:
                return None
            first = min(able, key=lambda task: task.turn.place)
            self._waiting.remove(first)
            self._running.append(first)
            return first

    def _ended(self, task: _Task) -> None:
        with self._lock:
            self._running.remove(task)

    def _done(self, task: _Task, result: "Future[Any]") -> None:
        self._ended(task)
        error = CancelledError() if result.cancelled() else result.exception()
        if isinstance(error, BrokenExecutor):
            self._fail(error)
        else:
            self._hand_on()
        if error is not None:
            task.future.set_exception(error)
        else:
            task.future.set_result(result.result())

    def _fail(self, error: BaseException) -> None:
        """End all that waits; an executor that has just broken must not be called by what it calls."""
        with self._lock:
            gone, self._waiting = self._waiting, []
        for task in gone:
            if task.future.set_running_or_notify_cancel():
                task.future.set_exception(error)


Case = TypeVar("Case")


def side_by_side(cases: Sequence[Case], share: int) -> list[Sequence[Case]]:
    """The cases in batches, in their order: at most a process's share in each and as many as there are lanes.

    Whether the last is by itself follows from how many there are, not from the share: the loops for one lane round
    otherwise than those for several, and the answer would depend on how many processes there are.
    """
    size = min(LANES[-1], max(1, share))
    beside = len(cases) - (len(cases) % LANES[-1] == 1)
    count = min(-(-beside // size), beside // 2)
    ends = [beside * number // count for number in range(1, count + 1)] if count else []
    if beside < len(cases):
        ends.append(len(cases))
    return [cases[first:end] for first, end in pairwise([0, *ends])]


class SerialExecutor(Executor):
    """Runs every call at once in this process; for one job, tests and debugging."""

    def submit(
        self, function: Callable[_Given, Result], /, *arguments: _Given.args, **keywords: _Given.kwargs
    ) -> "Future[Result]":
        """Call now and return a finished future."""
        future: Future[Result] = Future()
        try:
            future.set_result(function(*arguments, **keywords))
        except Exception as error:  # noqa: BLE001  handed on by the future, as every executor does
            future.set_exception(error)
        return future


def _start_worker() -> None:
    threadpool_limits(1)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    # a worker in the middle of a task would not notice that its parent was killed, and keep a core busy for minutes
    multiprocessing.parent_process().join()
    os._exit(1)


def worker_count(jobs: int | None) -> int:
    """How many processes `jobs` asks for; without it one per core. Raises SimulationError for what is no number."""
    if jobs is None:
        return os.cpu_count() or 1
    if not isinstance(jobs, Integral) or jobs < 1:
        raise SimulationError(
            f"jobs={jobs!r} is no whole number from 1 on: give one, or None for one per core"
        )
    return int(jobs)


PACKAGES = ("hasel_common", "hasel_sim")
"""What takes part in a simulation; a worker of a cluster must have the same sources of it."""


@contextmanager
def executor(
    jobs: int | None = None, scheduler: str | None = None, packages: Sequence[str] = PACKAGES
) -> Iterator[Executor]:
    """An executor for simulations: `jobs` processes (default: one per core), or the Dask scheduler at an address.

    packages: whose functions are called; only workers of the cluster that have the same sources get work. Linear
    algebra has one thread, here and in every process: its matrices are small, and on a machine that has other
    work its threads wait for each other several times as long as they work. Raises ClusterError when the scheduler
    cannot be reached or none of its workers fits; the futures raise it when all workers or the scheduler are lost.
    """
    with threadpool_limits(1), _executor(jobs, scheduler, packages) as pool:
        yield pool


@contextmanager
def _executor(jobs: int | None, scheduler: str | None, packages: Sequence[str]) -> Iterator[Executor]:
    if scheduler is not None:
        with cluster(scheduler, packages) as workers:
            turns = Turns(workers, workers.workers)
            workers.resized = turns.resize
            yield turns
        return
    count = worker_count(jobs)
    if count == 1:
        yield SerialExecutor()
        return
    context = multiprocessing.get_context("forkserver")
    with ProcessPoolExecutor(count, mp_context=context, initializer=_start_worker) as pool:
        try:
            yield Turns(pool, count)
        except BaseException:
            pool.shutdown(wait=False, cancel_futures=True)
            raise


def all_at_once(pool: Executor, calls: Sequence[Callable[[], Result]]) -> list[Result]:
    """Results of calls that have a pool simulate, in their order.

    Where it has several processes the calls go on at once: what one of them leaves idle another uses.
    """
    if not isinstance(pool, Turns) or len(calls) < 2:
        return [call() for call in calls]
    with ThreadPoolExecutor(len(calls)) as threads:
        return [future.result() for future in [threads.submit(call) for call in calls]]


def submit_all(
    pool: Executor, model: Model, runs: Sequence[Run], slopes_by: Sequence[str] = ()
) -> list["Future[Simulation]"]:
    """Start the simulation of every run, several side by side in each process; the futures are in the runs' order."""
    return submit_each(pool, [model], runs, [slopes_by])[0]


def submit_each(
    pool: Executor,
    models: Sequence[Model],
    runs: Sequence[Run],
    slopes_by: Sequence[Sequence[str]],
    ended: Callable[[int, int], None] | None = None,
) -> list[list["Future[Simulation]"]]:
    """Start the simulation of every run with every model, [models][runs]; slopes_by: names of each model's parameters.

    Runs of one model, and models of one kind with the same names, fill the lanes of a process together. ended: called
    with the numbers of model and run as soon as a simulation has ended, also by an error, from any thread.
    """
    futures: list[list[Future[Simulation]]] = [[Future() for _ in runs] for _ in models]
    if ended:
        for model, run in product(range(len(models)), range(len(runs))):
            futures[model][run].add_done_callback(partial(_tell, ended, model, run))
    alike: dict[tuple[ModelKind, tuple[str, ...]], list[int]] = {}
    for number, (model, names) in enumerate(zip(models, slopes_by, strict=True)):
        alike.setdefault((kind_of(model), tuple(names)), []).append(number)
    share = -(-len(models) * len(runs) // getattr(pool, "workers", 1))
    for (_, names), numbers in alike.items():
        # the longest first: those side by side are of like length
        by_length = sorted(product(numbers, range(len(runs))), key=lambda case: -len(runs[case[1]].time))
        for batch in side_by_side(by_length, share):
            asked = [futures[model][run] for model, run in batch]
            done = pool.submit(simulate_many, [(models[model], runs[run]) for model, run in batch], names)
            done.add_done_callback(partial(_hand_on, futures=asked))
    return futures


def _tell(ended: Callable[[int, int], None], model: int, run: int, _: "Future[Simulation]") -> None:
    ended(model, run)


def _hand_on(
    batch: "Future[list[Simulation | HaselSimError]]", futures: Sequence["Future[Simulation]"]
) -> None:
    """Give every run of a batch its own result or error."""
    failed = CancelledError() if batch.cancelled() else batch.exception()
    for future, result in zip(futures, [failed] * len(futures) if failed else batch.result(), strict=True):
        if isinstance(result, BaseException):
            future.set_exception(result)
        else:
            future.set_result(result)


def simulate_all(
    pool: Executor, model: Model, runs: Sequence[Run], slopes_by: Sequence[str] = ()
) -> list[Simulation]:
    """Simulate every run with one model, longest first so that all workers finish together."""
    return [future.result() for future in submit_all(pool, model, runs, slopes_by)]
