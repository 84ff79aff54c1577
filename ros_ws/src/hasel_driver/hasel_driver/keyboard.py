"""Lines from a terminal or a pipe, and single keys from a terminal."""

import os
import select
import sys
import termios
import tty
from collections.abc import Iterator
from contextlib import contextmanager


class Keyboard:
    """Standard input; `pressed` is always False where it is no terminal."""

    def __init__(self) -> None:
        self.is_terminal = sys.stdin.isatty()

    def line(self, prompt: str) -> str | None:
        """The next line; None at the end of the input."""
        try:
            return input(prompt if self.is_terminal else "")
        except EOFError:
            return None

    @contextmanager
    def single_keys(self) -> Iterator[None]:
        """Within, keys are seen at once and not echoed; Ctrl-C is a key like any other."""
        if not self.is_terminal:
            yield
            return
        before = termios.tcgetattr(sys.stdin)
        tty.setraw(sys.stdin, termios.TCSANOW)
        termios.tcflush(sys.stdin, termios.TCIFLUSH)
        try:
            yield
        finally:
            termios.tcsetattr(sys.stdin, termios.TCSANOW, before)

    def pressed(self) -> bool:
        """Whether a key was pressed since the last call, within `single_keys`."""
        if not self.is_terminal:
            return False
        ready, _, _ = select.select([sys.stdin], [], [], 0.0)
        if not ready:
            return False
        os.read(sys.stdin.fileno(), 1024)
        return True
