# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Long work, one at a time, in a thread of its own: with progress, and a way to break it off."""

import threading
import time
from collections import deque
from collections.abc import Callable
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass

from hasel_recording import RecordingError
from hasel_sim.errors import HaselSimError
from hasel_sysid.errors import SysidError

Progress = Callable[[str, float], None]
"""Called with a line of text and the share done, 0 to 1; it raises where the work is no longer wanted."""


class Cancelled(Exception):  # noqa: N818  no error: somebody asked for it
    """The work was broken off."""


@dataclass(frozen=True)
class Doing:
    """What is being worked on: title, the last line of text, the share done, 0 to 1, and the seconds since it began."""

    title: str
    text: str
    share: float
    seconds: float


@dataclass(frozen=True)
class Said:
    """A sentence for whoever looks; number: they count up; severity: positive, warning or negative."""

    number: int
    severity: str
    text: str


class Jobs:
    """said: sentences for every page, the last ones."""

    def __init__(self) -> None:
        self.said: deque[Said] = deque(maxlen=50)
        self._count, self._lock = 0, threading.Lock()
        self._thread: threading.Thread | None = None
        self._cancel = threading.Event()
        self._title, self._text, self._share, self._began = "", "", 0.0, 0.0

    @property
    def doing(self) -> Doing | None:
        """The work under way; None: none."""
        if self._thread is None:
            return None
        return Doing(self._title, self._text, self._share, time.monotonic() - self._began)

    def start(self, title: str, work: Callable[[Progress], object], done: str = "") -> None:
        """Begin; done: what to say at its end. Raises SysidError while something else is under way."""
        with self._lock:
            if self._thread is not None:
                raise SysidError(f"'{self._title}' is under way; wait for it, or cancel it")
            self._cancel.clear()
            self._title, self._text, self._share, self._began = title, "", 0.0, time.monotonic()
            self._thread = threading.Thread(target=self._run, args=(work, done), name="work", daemon=True)
            self._thread.start()

    def cancel(self) -> None:
        """Ask the work under way to end at its next step."""
        self._cancel.set()

    def wait(self, seconds: float | None = None) -> bool:
        """Wait for the end of what is under way; whether it has come."""
        thread = self._thread
        if thread is not None:
            thread.join(seconds)
        return self._thread is None

    def say(self, severity: str, text: str) -> None:
        """Let every page tell this once."""
        self._count += 1
        self.said.append(Said(self._count, severity, text))

    def _progress(self, text: str, share: float) -> None:
        if self._cancel.is_set():
            raise Cancelled
        self._text, self._share = text, max(self._share, min(share, 1.0))

    def _run(self, work: Callable[[Progress], object], done: str) -> None:
        try:
            work(self._progress)
            if done:
                self.say("positive", done)
        except (HaselSimError, SysidError, RecordingError) as error:
            self.say("negative", str(error))
        except BrokenProcessPool:
            lost = "a worker process ended early, perhaps for lack of memory; start again with --jobs 1"
            self.say("negative", lost)
        except OSError as error:
            why = f"{error.filename or 'a file'}: {error.strerror or error}"
            self.say("negative", f"{why}; choose another --output")
        except BaseException as error:
            if self._cancel.is_set():  # what it works with may be closed by now
                self.say("warning", f"{self._title}: cancelled, nothing was changed")
                return
            self.say("negative", f"{self._title} failed, please report it: {type(error).__name__}: {error}")
            raise
        finally:
            self._thread = None
