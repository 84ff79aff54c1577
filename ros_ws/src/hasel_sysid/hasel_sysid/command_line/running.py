"""What every command does alike: one sentence per error, warnings in one line, an exit code."""

import sys
import warnings
from collections.abc import Callable

from hasel_common.command_entry import BAD_INPUT, INTERRUPTED, in_a_sentence
from hasel_recording import RecordingError, RecordingWarning
from hasel_sim.errors import HaselSimError

from hasel_sysid.errors import SysidError

__all__ = ["BAD_INPUT", "INTERRUPTED", "MISLEADING", "run_command"]

MISLEADING = 3


def run_command(work: Callable[[], int | None]) -> int:
    """Run a command; its exit code is what `work` returns or 0, 2 after an error told on stderr, 130 after Ctrl-C."""
    with warnings.catch_warnings():
        warnings.simplefilter("always", RecordingWarning)
        warnings.showwarning = _show
        return in_a_sentence(work, (HaselSimError, SysidError, RecordingError))


def _show(message, category, filename, lineno, file=None, line=None) -> None:
    print(f"warning: {message}", file=sys.stderr)
