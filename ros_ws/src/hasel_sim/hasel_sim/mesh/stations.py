"""Where the columns of a mesh stand along the body: even within a segment, graded into the root of the fin.

The corner between the body's blunt end and the thin fin is singular: there even refinement converges at first order
only, while geometric grading towards it converges with the elements' own order (Babuska, Guo, The h-p version of the
finite element method, Computational Mechanics 1 (1986) 21).
"""

import numpy as np
from scipy.optimize import brentq

MUSCLE_ELEMENT = 2.0 / 3.0
"""Length of an element beside the spine over the body's largest height, where muscles bend it."""
PASSIVE_ELEMENT = 1.75
"""The same where no muscle lies between it and the nose: that part hardly bends."""
PLAIN_ELEMENT = 0.25
"""The same in a body without spine, whose own height sets the scale of what is to be resolved."""
MOST_PLAIN = 24
"""Elements along a slender body without spine: enough for the elastica, whatever its height."""
ROOT_ELEMENT = 1.0 / 16.0
"""Length of the elements on both sides of the fin's root over the spine's thickness, at density 1."""
THINNEST = 1.0 / 64.0
"""The same at any density: thinner ones no longer matter, and their shape spoils the solution."""
FIN_ELEMENTS, GAP_ELEMENTS = 14, 6
"""Elements along the fin, and along the last piece of the body before it."""


def spread(start: float, end: float, count: int) -> np.ndarray:
    """Ends of `count` equal elements from start to end, [count + 1]."""
    return np.linspace(start, end, count + 1)


def graded(start: float, end: float, first: float, count: int) -> np.ndarray:
    """Ends of `count` elements from start to end [m], each longer than the last by one factor, the first one given.

    Equal ones where that would make them shorter instead. [count + 1]
    """
    length = abs(end - start)
    if count < 2 or first * count >= length:
        return spread(start, end, count)
    powers = np.arange(count)
    largest = (length / first) ** (1 / (count - 1))
    growth = brentq(lambda g: first * (g**powers).sum() - length, 1.0, largest)
    ends = np.concatenate([[0.0], np.cumsum(growth**powers)])
    return start + np.sign(end - start) * length * ends / ends[-1]


def plain_stations(breaks: np.ndarray, height: float, density: float) -> np.ndarray:
    """Element ends along a body without spine that is cut at `breaks` [m] [n]; height: its largest [m]."""
    size = max(PLAIN_ELEMENT * height, (breaks[-1] - breaks[0]) / MOST_PLAIN) / density
    return _joined([spread(a, b, _count(b - a, size)) for a, b in zip(breaks[:-1], breaks[1:], strict=True)])


def spined_stations(
    breaks: np.ndarray, height: float, first_muscle: float, density: float, thickness: float, has_fin: bool
) -> np.ndarray:
    """Element ends along a body with a spine [m]; first_muscle: where the first muscle begins."""
    pieces = []
    for a, b in zip(breaks[:-1], breaks[1:], strict=True):
        passive = b <= first_muscle + 1e-9
        size = (PASSIVE_ELEMENT if passive else MUSCLE_ELEMENT) * height / density
        if has_fin and b == breaks[-1]:
            count = max(1, round(GAP_ELEMENTS * density)) + int(max(0.0, b - a - height) / size)
            pieces.append(graded(b, a, root_element(thickness, density), count)[::-1])
        else:
            pieces.append(spread(a, b, _count(b - a, size)))
    return _joined(pieces)


def fin_stations(start: float, end: float, thickness: float, density: float) -> np.ndarray:
    """Element ends along the fin [m], graded away from its root."""
    return graded(start, end, root_element(thickness, density), max(2, round(FIN_ELEMENTS * density)))


def root_element(thickness: float, density: float) -> float:
    """Length [m] of the elements on both sides of the fin's root."""
    return max(ROOT_ELEMENT / density, THINNEST) * thickness


def with_middles(ends: np.ndarray) -> np.ndarray:
    """The positions of all columns: element ends and the columns half-way between them, [2 n - 1]."""
    out = np.empty(2 * len(ends) - 1)
    out[::2] = ends
    out[1::2] = 0.5 * (ends[:-1] + ends[1:])
    return out


def _count(length: float, size: float) -> int:
    return max(1, round(length / size))


def _joined(pieces: list[np.ndarray]) -> np.ndarray:
    return np.concatenate([pieces[0], *(piece[1:] for piece in pieces[1:])])
