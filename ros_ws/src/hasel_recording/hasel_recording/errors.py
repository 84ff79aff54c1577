# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What can be wrong with a recording; every message is one sentence that ends with what to do."""

import sys
import warnings


class _OneLine:
    """What a message quotes from a file may hold any sign: what cannot be printed is shown as in a Python string."""

    def __str__(self) -> str:
        return "".join(sign if sign.isprintable() else repr(sign)[1:-1] for sign in super().__str__())


class RecordingError(_OneLine, Exception):
    """A recording cannot be read or written."""


class RecordingWarning(_OneLine, UserWarning):
    """A recording was read or written, but something in it was left out."""


def warn(sentence: str) -> None:
    """Give a RecordingWarning, at the line outside this package that asked for what was read or written."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_globals.get("__package__") == __package__:
        frame, level = frame.f_back, level + 1
    warnings.warn(sentence, RecordingWarning, stacklevel=level - 1)
