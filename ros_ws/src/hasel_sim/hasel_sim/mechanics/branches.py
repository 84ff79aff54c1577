"""Internal Maxwell branches of the material: stress that a strain leaves behind and that relaxes.

Each branch holds a second Piola stress Q with dQ/dt = g C : dE/dt - Q / tau; over a step h, exactly for a strain that
changes at a constant rate, Q1 = exp(-h/tau) Q0 + g phi(h/tau) C : (E1 - E0) with phi(r) = (1 - exp(-r)) / r.
J. C. Simo, T. J. R. Hughes, Computational Inelasticity, section 10.3.
"""

from collections.abc import Sequence

import numpy as np


class Branches:
    """The branches' moduli and times [branches, lanes].

    Their stresses are kept by whoever steps, [branches, elements, points, 3, lanes]. Steps [s] are one per lane.
    """

    def __init__(self, pairs: list[tuple[float, float]]) -> None:
        self.ratio = np.array([ratio for ratio, _ in pairs]).reshape(-1, 1)
        self.time = np.array([time for _, time in pairs]).reshape(-1, 1)
        self._factors: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

    @staticmethod
    def beside(each: Sequence["Branches"]) -> "Branches":
        """Those of several bodies, one lane after the other."""
        out = Branches([])
        out.ratio, out.time = (np.hstack([getattr(b, name) for b in each]) for name in ("ratio", "time"))
        return out

    def __len__(self) -> int:
        return len(self.ratio)

    def factors(self, step: float | np.ndarray | Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """What a step [s] leaves of Q, and what it adds per C : (E1 - E0), both [branches, lanes]."""
        key = np.asarray(step, dtype=float).tobytes()
        if key not in self._factors:
            r = np.frombuffer(key) / self.time
            self._factors = dict([*self._factors.items()][-7:])  # a run has few lengths of steps
            self._factors[key] = np.exp(-r), self.ratio * -np.expm1(-r) / r
        return self._factors[key]

    def history(self, stresses: np.ndarray, green: np.ndarray, step: float | np.ndarray) -> np.ndarray:
        """The part of the branches' stress after a step that no new strain changes, [elements, points, 3, lanes]."""
        left, gain = self.factors(step)
        return (left[:, None, None, None] * stresses).sum(axis=0) - gain.sum(axis=0) * green

    def advance(
        self, stresses: np.ndarray, green: np.ndarray, new_green: np.ndarray, step: float | np.ndarray
    ) -> np.ndarray:
        """Stresses of all branches at the end of a step."""
        left, gain = (factor[:, None, None, None] for factor in self.factors(step))
        return left * stresses + gain * (new_green - green)
