# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How far a long work has come: counted, with the time left, and shown as a bar on the terminal or lines in a log."""

import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from datetime import timedelta

_MEASURED_S = 1.0
"""What the usual speed counts beside the one that is measured: as much as so long a time of work."""
_STILL = 0.25
"""Share of its usual work that is expected of a stage that goes on although it has done so much."""
_TOO_RARE = 1 / 3
"""A stage is expected of a work only where more than this share of such works reach it: the few that take several times
as long would make all others look long.
"""
_LINE_EVERY_S = 10.0
"""In a log a line says that it goes on, also where no new stage begins."""
_FIRST_LINE_S = 4.0
"""The first one comes sooner: who has just begun wants to know whether to wait."""
_LOOK_EVERY_S = 0.5
"""So that no line is late by more, and a bar moves."""


@dataclass(frozen=True)
class Stage:
    """A part of a work. text: what is done; work: how much of it there usually is; chance: share of all such works that
    reach it; known: whether it is neither more nor less than that.
    """

    text: str
    work: float = 0.0
    chance: float = 1.0
    known: bool = False


@dataclass(frozen=True)
class HowFar:
    """stage: what is done now, or was last; done, of: how many were finished, and are expected in all (0: nothing tells
    it yet); certain: whether it will be so many; units: what is counted; share: of the work, 0 to 1; left_s: time left
    [s], None where nothing tells it yet.
    """

    stage: str
    done: int
    of: int
    certain: bool
    units: str
    share: float
    left_s: float | None

    def __str__(self) -> str:
        of = f" of {'' if self.certain else 'about '}{self.of}" if self.of else ""
        counted = f"{self.done}{of} {self.units}" if self.done else ""
        left = "" if self.left_s is None else f"about {timedelta(seconds=round(self.left_s))} left"
        return ", ".join(filter(None, [self.stage, counted, left]))


class Workload:
    """Counts what is done, and expects what usually follows the stages that were reached: a work that reached a rare
    one is one of the few that reach all that are as frequent.

    Who works begins stages and counts; who shows it looks at any time, from any thread.
    """

    def __init__(
        self,
        plan: Sequence[Stage] = (),
        units: str = "simulations",
        usual_speed: float | None = None,
        tell: Callable[[str, float], None] | None = None,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        """plan: the stages in their order; units: what is counted; usual_speed: work per second before any is measured;
        tell: called by `check` with a line of text and the share done (0 to 1), and may raise there to break the work
        off; clock: tells the time [s].
        """
        self._plan, self._units, self._usual_speed, self._tell = tuple(plan), units, usual_speed, tell
        self._clock, self._lock = clock, threading.Lock()
        self._texts: list[str] = []
        self._text = ""
        self._here, self._before = Stage(""), 0.0
        self._frequency = 1.0
        self._after = self._expected(-1)
        self._done, self._work, self._share = 0, 0.0, 0.0
        self._first: tuple[float, float] | None = None

    def expect(self, plan: Sequence[Stage]) -> None:
        """Go by this plan from now on."""
        with self._lock:
            self._plan = tuple(plan)
            self._after = self._expected(-1)

    def _expected(self, number: int) -> float:
        """Work of the stages that come after one of the plan, by how often they do."""
        later = [(min(1.0, stage.chance / self._frequency), stage.work) for stage in self._plan[number + 1 :]]
        return sum(chance * work for chance, work in later if chance > _TOO_RARE)

    @contextmanager
    def stage(self, stage: Stage) -> Iterator[None]:
        """Meanwhile a stage is worked on.

        One of the plan's texts is as the plan has it, unless it is known now. A stage within another one is a part of
        it, and lends its text only.
        """
        outermost = not self._texts
        with self._lock:
            self._texts.append(stage.text)
            self._text = ": ".join(self._texts)
            if outermost:
                number = next((n for n, one in enumerate(self._plan) if one.text == stage.text), None)
                self._here, self._before = stage, self._work
                if number is not None:
                    self._here = stage if stage.known else self._plan[number]
                    self._frequency = min(self._frequency, self._plan[number].chance)
                    self._after = self._expected(number)
        try:
            self.check()
            yield
        finally:
            with self._lock:
                self._texts.pop()
                if outermost:
                    self._here = Stage("")
                else:
                    self._text = ": ".join(self._texts)

    def did(self, work: float = 1.0) -> None:
        """Count one more, and the work that it was."""
        with self._lock:
            self._done += 1
            self._work += work
            if self._first is None:  # what went before it was the start of processes more than work
                self._first = self._clock(), self._work

    def check(self) -> None:
        """Tell how far it is: called between pieces of work, and raises where they are no longer wanted."""
        if self._tell:
            now = self.now()
            self._tell(str(now), now.share)

    def now(self) -> HowFar:
        """How far it is; the share never goes back, the time left follows what turns out."""
        with self._lock:
            if not self._plan:
                return HowFar(self._text, self._done, 0, False, self._units, 0.0, None)
            usual, done = self._here.work, self._work - self._before
            rest = max(usual - done, 0.0 if self._here.known else _STILL * usual) + self._after
            whole = self._work + rest
            self._share = max(self._share, self._work / whole if whole else 0.0)
            of = round(self._done * whole / self._work) if self._work else 0
            certain = self._here.known and not self._after
            return HowFar(self._text, self._done, of, certain, self._units, self._share, self._left(rest))

    def _left(self, rest: float) -> float | None:
        """Seconds for the rest, at the speed since the first piece was done."""
        seconds = work = 0.0
        if self._first is not None:
            began, before = self._first
            seconds, work = self._clock() - began, self._work - before
        if self._usual_speed is not None:
            seconds, work = seconds + _MEASURED_S, work + _MEASURED_S * self._usual_speed
        return rest * seconds / work if work else None


@contextmanager
def progress_bar(
    title: str, plan: Sequence[Stage] = (), units: str = "simulations", usual_speed: float | None = None
) -> Iterator[Workload]:
    """A bar on stderr that never goes back; what it gives counts the work, see there for its plan, units and speed.

    Where stderr is no terminal, it is lines; see `LogLines`.
    """
    from rich.console import Console  # takes a while, and who only counts shows nothing
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn

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
