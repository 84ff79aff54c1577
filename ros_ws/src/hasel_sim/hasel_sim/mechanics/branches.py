"""Internal Maxwell branches of the material: stress that a strain leaves behind and that relaxes.

Each branch holds a second Piola stress Q with dQ/dt = g C : dE/dt - Q / tau, which is a share of C : E when a run
starts; over a step h, exactly for a strain that changes at a constant rate,
Q1 = exp(-h/tau) Q0 + g phi(h/tau) C : (E1 - E0) with phi(r) = (1 - exp(-r)) / r.
J. C. Simo, T. J. R. Hughes, Computational Inelasticity, section 10.3.
"""

from collections.abc import Sequence

import numpy as np

from hasel_sim.mechanics import branch_loops as loops
from hasel_sim.simd import lane_tuple


class Branches:
    """The branches' moduli, times and shares of C : E at the start of a run [branches, lanes].

    Their stresses are kept by whoever steps, [branches, elements, points, 3, lanes]. Steps [s] are one per lane.
    """

    def __init__(
        self, pairs: Sequence[tuple[float, float]], fading: Sequence[tuple[float, float]] = ()
    ) -> None:
        """pairs: moduli [1] and times [s]; fading: shares at the start [1] and times of branches without a modulus."""
        every = [*((*pair, 0.0) for pair in pairs), *((0.0, time, share) for share, time in fading)]
        self.ratio, self.time, self.share = np.reshape(every, (-1, 3)).T[..., None]
        self._factors: dict[bytes, tuple[np.ndarray, np.ndarray]] = {}

    @staticmethod
    def beside(each: Sequence["Branches"]) -> "Branches":
        """Those of several bodies, one lane after the other."""
        out = Branches([])
        names = ("ratio", "time", "share")
        out.ratio, out.time, out.share = (np.hstack([getattr(b, name) for b in each]) for name in names)
        return out

    def __len__(self) -> int:
        return len(self.ratio)

    def at_start(self, green: np.ndarray) -> np.ndarray:
        """Stresses of all branches when a run starts, [branches, elements, points, 3, lanes]."""
        return self.share[:, None, None, None] * green

    def factors(self, step: float | np.ndarray | Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """What a step [s] leaves of Q, and what it adds per C : (E1 - E0), both [branches, lanes]."""
        key = np.asarray(step, dtype=float).tobytes()
        if key not in self._factors:
            r = np.frombuffer(key) / self.time
            self._factors = dict([*self._factors.items()][-7:])  # a run has few lengths of steps
            self._factors[key] = np.exp(-r), self.ratio * -np.expm1(-r) / r
        return self._factors[key]

    def history(self, stresses: np.ndarray, green: np.ndarray, step: float | np.ndarray) -> np.ndarray:
        """The part of the branches' stress after a step that no new strain changes, [elements, points, 3, lanes].

        A step of 0 means all of it, at rest for ever but for this.
        """
        if not np.any(step):
            return stresses.sum(axis=0)
        out = np.empty_like(green)
        loops.carried(*self.factors(step), stresses, green, out, lane_tuple(green.shape[-1]))
        return out

    def advance(
        self, stresses: np.ndarray, green: np.ndarray, new_green: np.ndarray, step: float | np.ndarray
    ) -> np.ndarray:
        """Stresses of all branches at the end of a step."""
        out, lane = np.empty((1, *stresses.shape)), lane_tuple(green.shape[-1])
        loops.advance(*self.factors(step), stresses[None], green[None], new_green[None], out, lane)
        return out[0]
