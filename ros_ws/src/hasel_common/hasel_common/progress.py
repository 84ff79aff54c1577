"""Showing how far a work has come: a bar on the terminal, lines in a log."""

import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import timedelta

from rich.console import Console
from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

from hasel_common.workload import HowFar, Stage, Workload

_LINE_EVERY_S = 10.0
"""In a log a line says that it goes on, also where no new stage begins."""
_FIRST_LINE_S = 4.0
"""The first one comes sooner: who has just begun wants to know whether to wait."""
_LOOK_EVERY_S = 0.5
"""So that no line is late by more, and a bar moves."""


@contextmanager
def progress_bar(
    title: str, plan: Sequence[Stage] = (), units: str = "simulations", usual_speed: float | None = None
) -> Iterator[Workload]:
    """A bar on stderr that never goes back; what it gives counts the work, see there for its plan, units and speed.

    Where stderr is no terminal, it is lines; see `LogLines`.
    """
    work = Workload(plan, units, usual_speed)
    console = Console(stderr=True)
    if not console.is_terminal:
        with _looked_at(LogLines(title, work.now).look):
            yield work
        return
    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeElapsedColumn())
    with Progress(*columns, console=console) as bar:
        task = bar.add_task(title, total=1.0)

        def look() -> None:
            now = work.now()
            bar.update(task, description=str(now) or title, completed=now.share)

        with _looked_at(look):
            yield work
        look()


@contextmanager
def _looked_at(look: Callable[[], None]) -> Iterator[None]:
    """Look again and again from a thread of its own: what is at work may say nothing for long."""
    ended = threading.Event()

    def again() -> None:
        while not ended.wait(_LOOK_EVERY_S):
            look()

    thread = threading.Thread(target=again, name="progress", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


@contextmanager
def counted(title: str, units: str, total: int | None) -> Iterator[Callable[[int], None]]:
    """The same over `total` steps, such as frames (None: not known how many); call it with how many are done."""
    stage = Stage(title, float(total or 0), known=True)
    with progress_bar(title, [stage] if total else [], units) as work, work.stage(stage):

        def show(done: int) -> None:
            for _ in range(done - work.now().done):
                work.did()

        yield show


class LogLines:
    """A line for every stage, and one each 10 s within it: what is done, how many of how many, how long still.

    The first line comes within 5 s. A stage of the title's own name has no line at its begin.
    """

    def __init__(
        self,
        title: str,
        now: Callable[[], HowFar],
        say: Callable[[str], None] = lambda line: print(line, file=sys.stderr, flush=True),
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """now: tells how far it is; say: takes a line; clock: tells the time [s]."""
        self._title, self._now, self._say, self._clock = title, now, say, clock
        self._began = self._said_at = clock()
        self._last, self._wait = title, _FIRST_LINE_S

    def look(self) -> None:
        """Say a line where one is due."""
        now, time_s = self._now(), self._clock()
        if now.stage in ("", self._last) and time_s - self._said_at < self._wait:
            return
        self._last, self._said_at, self._wait = now.stage or self._last, time_s, _LINE_EVERY_S
        named = now.stage.partition(": ")[0] == self._title
        what = str(now) if named else ": ".join(filter(None, [self._title, str(now)]))
        share = f"{now.share:.0%}, " if now.share else ""
        self._say(f"{what} ({share}{timedelta(seconds=round(time_s - self._began))} so far)")
