"""What can be wrong with a recording; every message is one sentence that ends with what to do."""

import difflib
from collections.abc import Iterable


class RecordingError(Exception):
    """A recording cannot be read or written."""


class RecordingWarning(UserWarning):
    """A recording was read or written, but something in it was left out."""


def nearest(name: str, known: Iterable[str], similarity: float = 0.75) -> str | None:
    """Return the known name most like `name`, or None when none is at least this similar (0 to 1)."""
    matches = difflib.get_close_matches(name, list(known), n=1, cutoff=similarity)
    return matches[0] if matches else None
