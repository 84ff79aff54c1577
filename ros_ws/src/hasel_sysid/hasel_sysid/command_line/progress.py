"""Progress on the terminal with the time left."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

from rich.console import Console
from rich.progress import (
    BarColumn,
    Progress,
    TaskProgressColumn,
    TextColumn,
    TimeElapsedColumn,
    TimeRemainingColumn,
)

Show = Callable[[str, float], None]
"""Called with a line of text and the share done, 0 to 1."""


@contextmanager
def progress_bar(title: str) -> Iterator[Show]:
    """A bar on stderr; call what it gives with a line of text and the share done, 0 to 1."""
    console = Console(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=not console.is_terminal) as bar:
        task = bar.add_task(title, total=1.0)

        def show(text: str, share: float) -> None:
            bar.update(task, description=text, completed=min(max(share, 0.0), 1.0))

        yield show


def part(progress: Show, title: str, begin: float, end: float) -> Show:
    """A part of a longer work that takes the shares from `begin` to `end` of the bar."""
    return lambda text, share: progress(title + text, begin + (end - begin) * min(max(share, 0.0), 1.0))
