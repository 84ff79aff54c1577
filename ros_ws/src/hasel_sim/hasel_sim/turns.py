"""Tasks for the processes of an executor: what is asked for goes before what is only foreseen."""

import threading
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import partial
from itertools import count

_ASKED = 0


@dataclass(eq=False)
class Turn:
    """A place in the order of a `Turns`, the first ones first; given_up: nobody wants its results any more."""

    place: int = _ASKED
    given_up: bool = False


@dataclass(frozen=True, eq=False)
class _Task:
    turn: Turn
    call: Callable
    future: Future = field(default_factory=Future)


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

    def submit(self, function: Callable, /, *arguments, **keywords) -> Future:
        """A task in the turn of this thread; one of a turn that was given up is cancelled."""
        turn = getattr(self._of_thread, "turn", None) or Turn()
        task = _Task(turn, partial(function, *arguments, **keywords))
        with self._lock:
            wanted = not turn.given_up
            if wanted:
                self._waiting.append(task)
        if wanted:
            self._hand_on()
        else:
            task.future.cancel()
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

    def give_up(self, turn: Turn) -> None:
        """Cancel what waits in a turn, and whatever is still submitted in it."""
        with self._lock:
            turn.given_up = True
            gone = [task for task in self._waiting if task.turn is turn]
            self._waiting = [task for task in self._waiting if task.turn is not turn]
        for task in gone:
            task.future.cancel()

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

    def _done(self, task: _Task, result: Future) -> None:
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
