# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Internal Maxwell branches of the material: stress that a strain leaves behind and that relaxes.

Each branch holds a second Piola stress Q with dQ/dt = g C : dE/dt - Q / tau, which is a share of C : E when a run
starts; over a step h, exactly for a strain that changes at a constant rate,
Q1 = exp(-h/tau) Q0 + g phi(h/tau) C : (E1 - E0) with phi(r) = (1 - exp(-r)) / r.
J. C. Simo, T. J. R. Hughes, Computational Inelasticity, section 10.3.

Stresses are [branches, elements, points, 3, lanes], C : E [elements, points, 3, lanes]; derivatives have the columns
first. What a step leaves and adds: left, gain [branches, lanes].
"""

from collections.abc import Sequence

import numpy as np
from numba import njit

from hasel_sim.mechanics.constitutive import deformation, green_stress_direction
from hasel_sim.mesh.mesh import Places
from hasel_sim.simd import LaneTuple, lane_tuple, load, store, zero

StepLength = float | np.ndarray | Sequence[float]
"""[s], the same for all lanes, or one each [lanes]."""


@njit(cache=True, fastmath=True, error_model="numpy")
def carried(
    left: np.ndarray,
    gain: np.ndarray,
    stresses: np.ndarray,
    green: np.ndarray,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """The part of the branches' stress after a step that no new strain changes, [elements, points, 3, lanes]."""
    lanes = len(lane)
    for at in range(0, out.size, lanes):
        total = zero(lane)
        for b in range(stresses.shape[0]):
            total = total + load(left, b * lanes, lane) * load(stresses, b * out.size + at, lane)
            total = total - load(gain, b * lanes, lane) * load(green, at, lane)
        store(out, at, total)


@njit(cache=True, fastmath=True, error_model="numpy")
def carried_columns(
    left: np.ndarray,
    gain: np.ndarray,
    stresses: np.ndarray,
    green: np.ndarray,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Derivatives of what the branches carry over a step, [columns, elements, points, 3, lanes]."""
    for c in range(green.shape[0]):
        carried(left, gain, stresses[c], green[c], out[c], lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def green_along(
    moved: np.ndarray,
    F: np.ndarray,
    places: Places,
    shear: np.ndarray,
    lame: np.ndarray,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Derivatives of C : E along those of the positions, moved [columns, nodes, 2, lanes], at a deformation F."""
    elements, gradients, _, stretch = places
    change = np.empty_like(F)
    for c in range(moved.shape[0]):
        deformation(moved[c], elements, gradients, stretch, change, lane)
        green_stress_direction(F, change, shear, lame, out[c], lane)


@njit(cache=True, fastmath=True, error_model="numpy")
def advance_stresses(
    left: np.ndarray,
    gain: np.ndarray,
    stresses: np.ndarray,
    green: np.ndarray,
    new_green: np.ndarray,
    out: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Derivatives of the branches' stresses at the end of a step, where those of C : E are `new_green`."""
    lanes, branches = len(lane), stresses.shape[1]
    size = green.shape[1] * green.shape[2] * green.shape[3] * lanes
    for c in range(green.shape[0]):
        for at in range(0, size, lanes):
            more = load(new_green, c * size + at, lane) - load(green, c * size + at, lane)
            for b in range(branches):
                place = (c * branches + b) * size + at
                old = load(left, b * lanes, lane) * load(stresses, place, lane)
                store(out, place, old + load(gain, b * lanes, lane) * more)


@njit(cache=True, fastmath=True, error_model="numpy")
def add_parameter(
    left: np.ndarray,
    gain: np.ndarray,
    stresses: np.ndarray,
    green: np.ndarray,
    own: np.ndarray,
    factor: np.ndarray,
    more: np.ndarray,
    more_green: np.ndarray,
    lane: LaneTuple,
) -> None:
    """Add to the derivatives `more` and `more_green` of one column a factor [lanes] times what the branches and C : E
    of one body are at the end of a step: stresses and green at its beginning, own C : E at its end.
    """
    lanes, branches, size = len(lane), stresses.shape[0], green.size
    times = load(factor, 0, lane)
    for at in range(0, size, lanes):
        new = load(own, at, lane)
        change = new - load(green, at, lane)
        store(more_green, at, load(more_green, at, lane) + times * new)
        for b in range(branches):
            place = b * size + at
            end = (
                load(left, b * lanes, lane) * load(stresses, place, lane)
                + load(gain, b * lanes, lane) * change
            )
            store(more, place, load(more, place, lane) + times * end)


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

    def factors(self, step: StepLength) -> tuple[np.ndarray, np.ndarray]:
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
        carried(*self.factors(step), stresses, green, out, lane_tuple(green.shape[-1]))
        return out

    def advance(
        self, stresses: np.ndarray, green: np.ndarray, new_green: np.ndarray, step: float | np.ndarray
    ) -> np.ndarray:
        """Stresses of all branches at the end of a step."""
        out, lane = np.empty((1, *stresses.shape)), lane_tuple(green.shape[-1])
        advance_stresses(*self.factors(step), stresses[None], green[None], new_green[None], out, lane)
        return out[0]
