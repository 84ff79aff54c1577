"""Which parts of a long stream are worth fitting."""

import numpy as np

REST_S = 2.0
"""After this long at 0 V the body is at rest."""
_BEFORE_S, AFTER_S = 0.25, 1.0
"""Of the rest, so much is kept around what is driven: the start, and the ringing."""


def driven_parts(time: np.ndarray, voltage: np.ndarray, end: float) -> list[tuple[float, float]]:
    """Begin and end [s] of the stretches between long rests.

    time [s] [n], voltage [V] [n, 2], each holding until the next; end [s] of the stream. A body that is never driven
    swings by itself: it is one stretch.
    """
    on = voltage.any(axis=1)
    if not on.any():
        return [(float(time[0]), end)]
    switched = np.flatnonzero(np.diff(np.concatenate([[False], on, [False]]).astype(int)))
    edges = np.append(time, end)[switched].reshape(-1, 2)
    parts = [list(edges[0])]
    for begin, stop in edges[1:]:
        if begin - parts[-1][1] > REST_S:
            parts.append([begin, stop])
        else:
            parts[-1][1] = stop
    first = float(time[0])
    return [(max(first, begin - _BEFORE_S), min(end, stop + AFTER_S)) for begin, stop in parts]
