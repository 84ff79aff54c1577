# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Where every command begins and how it ends: the machine as it is, no stack trace, not later than its parent."""

import errno
import os
import platform
import signal
import sys
import tempfile
import threading
import time
import traceback
from collections.abc import Callable
from concurrent.futures import BrokenExecutor
from concurrent.futures.process import BrokenProcessPool
from datetime import datetime
from functools import wraps
from itertools import takewhile
from pathlib import Path
from typing import Any

BAD_INPUT, UNEXPECTED, INTERRUPTED = 2, 70, 130
_PERIOD_S = 0.5
_PR_SET_PDEATHSIG = 1
REMEDIES = {
    **dict.fromkeys((errno.ENOSPC, errno.EDQUOT), "free some space, or write elsewhere"),
    **dict.fromkeys((errno.EACCES, errno.EPERM), "choose another place, or ask for the permission"),
    errno.EROFS: "choose another place to write to",
    errno.ENOENT: "check the name",
    **dict.fromkeys((errno.EEXIST, errno.ENOTDIR), "a folder is expected there: choose another name"),
    errno.EMFILE: "close other programs, or raise the limit with `ulimit -n`",
    errno.ENOMEM: "close other programs, or try again with --jobs 1",
    errno.EADDRINUSE: "choose another port",
}


def command(main: Callable[..., int | None]) -> Callable[..., int]:
    """A command's main function, with the machine prepared before it and everything caught that may leave it.

    --version is answered here, before anything is imported, with the version of the package that the command is of.
    """

    @wraps(main)
    def guarded(*arguments: Any, **options: Any) -> int:
        def work() -> int | None:
            given = arguments[0] if arguments and arguments[0] is not None else sys.argv[1:]
            if "--version" in takewhile(lambda each: each not in ("--", "--ros-args"), given):
                from importlib.metadata import version  # takes as long to import as all else here

                package = main.__module__.partition(".")[0]
                print(f"{package} {version(package)}")
                return 0
            prepare_machine()
            return main(*arguments, **options)

        return in_a_sentence(work)

    return guarded


def in_a_sentence(
    work: Callable[[], int | None], expected: tuple[type[Exception], ...] = (), code: int = BAD_INPUT
) -> int:
    """What `work` returns, or 0; after an error, which is told on stderr in one sentence, an exit code.

    expected: errors that are sentences themselves, with `code`. An error that nobody foresaw writes a file to send, and
    says where (70); Ctrl-C gives 130.
    """
    try:
        return work() or 0
    except expected as error:
        return _refuse(str(error), code)
    except KeyboardInterrupt:
        print("stopped", file=sys.stderr)
        return INTERRUPTED
    except BrokenProcessPool:
        return _refuse(
            "a worker process ended early, perhaps for lack of memory; try again with --jobs 1", code
        )
    except BrokenExecutor as error:  # of a cluster: a sentence itself
        return _refuse(str(error), code)
    except BrokenPipeError:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except MemoryError:
        return _refuse("the memory is not enough: give fewer recordings at once, or try --jobs 1", code)
    except OSError as error:
        return _refuse(of_system(error), code)
    except Exception as error:  # noqa: BLE001  nothing else may leave a command
        return _refuse(_unforeseen(error), UNEXPECTED)


def prepare_machine() -> None:
    """Make the best of a locale without UTF-8, no home, a notebook's settings and other programs beside the data."""
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")
    os.environ.pop("MPLBACKEND", None)  # of a notebook: files need none
    os.environ["PYTHONSAFEPATH"] = (
        "1"  # a lab's own signal.py beside the data is none of ours, in workers too
    )
    sys.path[:] = [each for each in sys.path if each]
    own = Path("~").expanduser()
    if not (own.is_absolute() and own.is_dir() and os.access(own, os.W_OK | os.X_OK)):
        home = Path(tempfile.gettempdir()) / f"hasel-home-{os.getuid()}"
        home.mkdir(mode=0o700, exist_ok=True)
        if home.stat().st_uid == os.getuid():
            os.environ["HOME"] = str(home)


def of_system(error: OSError) -> str:
    """What the system refused, as a sentence: what it was about, why, and what to do."""
    about = error.filename if error.filename is not None else "the system"
    if any("multiprocessing" in frame.filename for frame in traceback.extract_tb(error.__traceback__)):
        return f"processes cannot work together here ({error.strerror or error}): try again with --jobs 1"
    if error.errno == errno.ENOENT and not error.filename:
        about = "a file"
    what = error.strerror or str(error) or type(error).__name__
    return f"{about}: {what}: {REMEDIES.get(error.errno or 0, 'check it and try again')}"


def _unforeseen(error: Exception) -> str:
    name = f"hasel_error_{datetime.now():%Y%m%d_%H%M%S}_{os.getpid()}.txt"
    said = "".join(traceback.format_exception_only(error)).strip().splitlines()[-1]
    machine = f"command: {sys.argv}\nPython {sys.version} on {platform.platform()}\n\n"
    text = machine + "\n".join(traceback.format_exception(error))
    for folder in (Path.cwd(), Path(tempfile.gettempdir())):
        try:
            (folder / name).write_text(text, encoding="utf-8")
        except OSError:
            continue
        return (
            f"an error that was not foreseen ({said}); what happened is written to {folder / name}: please send that "
            "file, and the recording if you may, as CONTRIBUTING.md says"
        )
    return f"an error that was not foreseen ({said}); nothing could be written about it"


def _refuse(sentence: str, code: int) -> int:
    print(f"error: {sentence}", file=sys.stderr)
    return code


def end_with_parent() -> None:
    """From here on SIGTERM comes soon after the parent has ended, however; not to what was started with `nohup`."""
    if signal.getsignal(signal.SIGHUP) == signal.SIG_IGN:
        return
    parent = os.getppid()

    def watch() -> None:
        while os.getppid() == parent:
            time.sleep(_PERIOD_S)
        os.kill(os.getpid(), signal.SIGTERM)

    threading.Thread(target=watch, name="parent", daemon=True).start()


def end_at_once_with_parent() -> None:
    """The same at once, `nohup` or not, for what may be armed; also where only the parent's thread ends. Linux only."""
    if not sys.platform.startswith("linux"):
        return
    import ctypes  # takes a while, and few commands need it

    parent = os.getppid()
    ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGTERM)
    if os.getppid() != parent:  # it has ended just now
        os.kill(os.getpid(), signal.SIGTERM)
