# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What somebody may have meant by a name that is not known."""

import difflib
from collections.abc import Iterable


def nearest(name: str, known: Iterable[str], similarity: float = 0.75) -> str | None:
    """Return the known name most like `name`, or None when none is at least this similar (0 to 1)."""
    matches = difflib.get_close_matches(name, list(known), n=1, cutoff=similarity)
    return matches[0] if matches else None


def nearest_name(name: str, known: Iterable[str]) -> str:
    """Return "the nearest known one is 'x'" or the list of what is known, for the end of a message."""
    known = sorted(known)
    near = nearest(name, known, similarity=0.5)
    if near is not None:
        return f"the nearest known one is '{near}'"
    return f"known are {', '.join(known)}" if known else "none is known"
