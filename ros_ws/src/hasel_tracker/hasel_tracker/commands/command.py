"""What every command does alike: errors as one sentence, progress with the time left."""

from collections.abc import Callable

from hasel_common.command_entry import in_a_sentence
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

from hasel_tracker.errors import TrackerError


def run_command(work: Callable[[], None]) -> int:
    """Run a command; returns its exit code: 0, 1 after an error (told on stderr), 130 after Ctrl-C."""
    return in_a_sentence(work, (TrackerError,), code=1)


def progress_bar() -> Progress:
    """A progress bar on stderr."""
    return Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeRemainingColumn(),
        console=Console(stderr=True),
    )
