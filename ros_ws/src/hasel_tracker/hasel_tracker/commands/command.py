"""What every command does alike: errors as one sentence."""

from collections.abc import Callable

from hasel_common.command_entry import in_a_sentence

from hasel_tracker.errors import TrackerError


def run_command(work: Callable[[], None]) -> int:
    """Run a command; returns its exit code: 0, 1 after an error (told on stderr), 130 after Ctrl-C."""
    return in_a_sentence(work, (TrackerError,), code=1)
