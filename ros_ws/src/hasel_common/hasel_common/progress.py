"""Progress with the time left: a bar on the terminal, lines in a log."""

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import timedelta

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    ProgressColumn,
    Task,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
)
from rich.text import Text

Show = Callable[[str, float], None]
"""Called with a line of text and the share done, 0 to 1."""


_ENOUGH_TO_TELL = 0.02
"""Share done before which what is left is not told."""
_LINE_EVERY_S = 10.0
"""In a log a line says that it goes on, also where no new stage begins."""


def time_left(elapsed_s: float, share: float) -> str:
    """Such as `about 0:02:10 left`, if the rest goes on as what was done; empty at the very beginning."""
    if share < _ENOUGH_TO_TELL or not elapsed_s:
        return ""
    return f"about {timedelta(seconds=round(elapsed_s * (1.0 - share) / share))} left"


class TimeLeft(ProgressColumn):
    """How long the rest takes if it goes on as what was done; steps are too uneven to go by the last ones."""

    def render(self, task: Task) -> Text:
        """Such as `about 0:02:10 left`; nothing at the very beginning."""
        return Text(time_left(task.elapsed or 0.0, task.completed))


@contextmanager
def progress_bar(title: str) -> Iterator[Show]:
    """A bar on stderr that never goes back; call what it gives with a line of text and the share done, 0 to 1.

    Where stderr is no terminal, it is lines; see `log_lines`.
    """
    console = Console(stderr=True)
    if not console.is_terminal:
        yield never_back(log_lines(title))
        return
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
        TimeLeft(),
    )
    with Progress(*columns, console=console) as bar:
        task = bar.add_task(title, total=1.0)
        yield never_back(lambda text, share: bar.update(task, description=text, completed=share))


@contextmanager
def counted(title: str, units: str, total: int | None) -> Iterator[Callable[[int], None]]:
    """The same over `total` steps, such as frames (None: not known how many); call it with how many are done.

    In a log nothing is said of what takes less than ten seconds.
    """
    of = f" of {total}" if total else ""
    with progress_bar(title) as show:
        yield lambda done: show(f"{title}: {done}{of} {units}", done / total if total else 0.0)


def log_lines(title: str, clock: Callable[[], float] = time.monotonic) -> Show:
    """A line on stderr for every stage, and one each 10 s within it: what is done, how long so far, how long still.

    A stage is named by what stands before a text's first colon, else by its first word; one of the title's own name
    has no line at its begin.
    """
    begun = clock()
    last, said_at = title, begun

    def show(text: str, share: float) -> None:
        nonlocal last, said_at
        now = clock()
        stage = text.partition(": ")[0] if ": " in text else text.partition(" ")[0]
        if stage == last and now - said_at < _LINE_EVERY_S:
            return
        last, said_at = stage, now
        left = time_left(now - begun, share)
        times = f"{timedelta(seconds=round(now - begun))} so far{f', {left}' if left else ''}"
        what = text if stage == title else f"{title}: {text}"
        print(f"{what} ({f'{share:.0%}, ' if share else ''}{times})", file=sys.stderr, flush=True)

    return show


def never_back(progress: Show) -> Show:
    """Shares that only grow, up to 1: a step that turns out to be longer than was thought stays where it is."""
    done = 0.0

    def show(text: str, share: float) -> None:
        nonlocal done
        done = max(done, min(share, 1.0))
        progress(text, done)

    return show


def part(progress: Show, title: str, begin: float, end: float) -> Show:
    """A part of a longer work that takes the shares from `begin` to `end` of the bar."""
    return lambda text, share: progress(title + text, begin + (end - begin) * min(max(share, 0.0), 1.0))
