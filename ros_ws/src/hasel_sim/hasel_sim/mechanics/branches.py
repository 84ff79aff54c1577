"""Internal Maxwell branches of the material: stress that a strain leaves behind and that relaxes.

Each branch holds a second Piola stress Q with dQ/dt = g C : dE/dt - Q / tau; over a step h, exactly for a strain that
changes at a constant rate, Q1 = exp(-h/tau) Q0 + g phi(h/tau) C : (E1 - E0) with phi(r) = (1 - exp(-r)) / r.
J. C. Simo, T. J. R. Hughes, Computational Inelasticity, section 10.3.
"""

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numba import njit

_MOST_KEPT = 16
Kept = TypeVar("Kept")


@njit(cache=True, fastmath=True)
def green_stress(F, shear, lame, out):
    """C : E (xx, yy, xy) of the Green strain at every Gauss point, [elements, points, 3]."""
    for e in range(F.shape[0]):
        for g in range(F.shape[1]):
            a, b, c, d = F[e, g, 0], F[e, g, 1], F[e, g, 2], F[e, g, 3]
            xx, yy = 0.5 * (a * a + c * c - 1.0), 0.5 * (b * b + d * d - 1.0)
            out[e, g, 0] = lame[e] * (xx + yy) + 2.0 * shear[e] * xx
            out[e, g, 1] = lame[e] * (xx + yy) + 2.0 * shear[e] * yy
            out[e, g, 2] = shear[e] * (a * b + c * d)


@njit(cache=True, fastmath=True)
def green_stress_direction(F, change, shear, lame, out):
    """Change of C : E along a change of F, both [elements, points, 4], into out [elements, points, 3]."""
    for e in range(F.shape[0]):
        for g in range(F.shape[1]):
            a, b, c, d = F[e, g, 0], F[e, g, 1], F[e, g, 2], F[e, g, 3]
            p, q, r, s = change[e, g, 0], change[e, g, 1], change[e, g, 2], change[e, g, 3]
            xx, yy = a * p + c * r, b * q + d * s
            out[e, g, 0] = lame[e] * (xx + yy) + 2.0 * shear[e] * xx
            out[e, g, 1] = lame[e] * (xx + yy) + 2.0 * shear[e] * yy
            out[e, g, 2] = shear[e] * (a * q + b * p + c * s + d * r)


def kept(known: dict[float, Kept], step: float, compute: Callable[[float], Kept]) -> Kept:
    """What depends on a step's length [s] only; a recording has two or three lengths, a live run may have many."""
    if step not in known:
        if len(known) >= _MOST_KEPT:
            known.clear()
        known[step] = compute(step)
    return known[step]


class Branches:
    """The branches' moduli and times; their stresses are kept by whoever steps, [branches, elements, points, 3]."""

    def __init__(self, pairs: list[tuple[float, float]]) -> None:
        self.ratio = np.array([ratio for ratio, _ in pairs])
        self.time = np.array([time for _, time in pairs])
        self._factors: dict[float, tuple[np.ndarray, np.ndarray]] = {}

    def __len__(self) -> int:
        return len(self.ratio)

    def factors(self, step: float) -> tuple[np.ndarray, np.ndarray]:
        """What a step [s] leaves of Q, and what it adds per C : (E1 - E0); one value per branch."""
        return kept(self._factors, step, self._factors_of)

    def _factors_of(self, step: float) -> tuple[np.ndarray, np.ndarray]:
        r = step / self.time
        return np.exp(-r), self.ratio * -np.expm1(-r) / r

    def history(self, stresses: np.ndarray, green: np.ndarray, step: float) -> np.ndarray:
        """The part of the branches' stress after a step that no new strain changes, [elements, points, 3]."""
        left, gain = self.factors(step)
        return (left @ stresses.reshape(len(left), -1)).reshape(green.shape) - gain.sum() * green

    def advance(
        self, stresses: np.ndarray, green: np.ndarray, new_green: np.ndarray, step: float
    ) -> np.ndarray:
        """Stresses of all branches at the end of a step."""
        left, gain = self.factors(step)
        return left[:, None, None, None] * stresses + gain[:, None, None, None] * (new_green - green)
