"""Progress on the terminal with the time left."""

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


class TimeLeft(ProgressColumn):
    """How long the rest takes if it goes on as what was done; steps are too uneven to go by the last ones."""

    def render(self, task: Task) -> Text:
        """Such as `about 0:02:10 left`; nothing at the very beginning."""
        if task.completed < _ENOUGH_TO_TELL or not task.elapsed:
            return Text("")
        left = task.elapsed * (1.0 - task.completed) / task.completed
        return Text(f"about {timedelta(seconds=round(left))} left")


@contextmanager
def progress_bar(title: str) -> Iterator[Show]:
    """A bar on stderr that never goes back; call what it gives with a line of text and the share done, 0 to 1."""
    console = Console(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
        TimeLeft(),
    )
    with Progress(*columns, console=console, transient=not console.is_terminal) as bar:
        task = bar.add_task(title, total=1.0)
        yield never_back(lambda text, share: bar.update(task, description=text, completed=share))


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
