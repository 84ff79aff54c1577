"""What every command does alike: one sentence per error, warnings in one line, an exit code."""

import os
import sys
import warnings
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool

from hasel_recording import RecordingError, RecordingWarning
from hasel_sim.errors import HaselSimError

from hasel_sysid.errors import SysidError

BAD_INPUT, MISLEADING, INTERRUPTED = 2, 3, 130


def run_command(work: Callable[[], int | None]) -> int:
    """Run a command; its exit code is what `work` returns or 0, 2 after an error told on stderr, 130 after Ctrl-C."""
    with warnings.catch_warnings():
        warnings.simplefilter("always", RecordingWarning)
        usual = warnings.showwarning

        def show(message, category, filename, lineno, file=None, line=None) -> None:
            if issubclass(category, RecordingWarning):
                print(f"warning: {message}", file=sys.stderr)
            else:
                usual(message, category, filename, lineno, file, line)

        warnings.showwarning = show
        try:
            return work() or 0
        except (HaselSimError, SysidError, RecordingError) as error:
            return _refuse(str(error))
        except BrokenProcessPool:
            return _refuse(
                "a worker process ended early, perhaps for lack of memory; try again with --jobs 1"
            )
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            return 0
        except OSError as error:
            return _refuse(
                f"{error.filename or 'a file'}: {error.strerror or error}; choose another --output"
            )
        except KeyboardInterrupt:
            print("stopped", file=sys.stderr)
            return INTERRUPTED


def _refuse(sentence: str) -> int:
    print(f"error: {sentence}", file=sys.stderr)
    return BAD_INPUT
