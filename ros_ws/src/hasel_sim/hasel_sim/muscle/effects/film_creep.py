# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Film creep: films and seals go on yielding while the muscle is contracted, and remember it."""

from types import SimpleNamespace

import numpy as np
from numba import njit

from hasel_sim.effects.base import EffectParameter
from hasel_sim.muscle.effect import MuscleEffect


class FilmCreep(MuscleEffect):
    """One Kelvin element driven by the contraction."""

    id = "film_creep"
    physics = "Films and seals yield to the shape they are held in: contraction goes on growing, and some of it stays."
    equation = "x = x_0 + z, dz/dt = (g x_0 - z) / tau"
    parameters = (
        EffectParameter(
            "share", "g", "1", 0.0, 0.0, 0.5, 0.03, "polypropylene and polyester films, 1 to 20 % (estimate)"
        ),
        EffectParameter(
            "time",
            "tau",
            "s",
            10.0,
            0.5,
            1000.0,
            10.0,
            "seconds to many minutes",
            scan=(2.0, 10.0, 50.0, 200.0),
        ),
    )
    signature = "Drifts on while the voltage is held; what is left after release fades as slowly."
    citation = "Ferry, Viscoelastic Properties of Polymers, 3rd ed. (1980), chapter 1"
    in_time = True

    def follow(self, time: np.ndarray, contraction: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction [m] with what has crept."""
        return contraction + _crept(time, contraction, p.share, p.time, False)

    def before(self, time: np.ndarray, contraction: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction [m] that is in balance."""
        return contraction - _crept(time, contraction, p.share, p.time, True)


@njit(cache=True)
def _crept(
    time: np.ndarray, contraction: np.ndarray, share: float, relaxation: float, whole: bool
) -> np.ndarray:
    """z [m] [n], exact for a balance x_0 that holds from each time to the next; whole: given is x_0 + z, not x_0."""
    out = np.zeros_like(contraction)
    for i in range(1, len(contraction)):
        fade = np.exp(-(time[i] - time[i - 1]) / relaxation)
        balance = contraction[i - 1] - (out[i - 1] if whole else 0.0)
        out[i] = out[i - 1] * fade + share * balance * (1.0 - fade)
    return out
