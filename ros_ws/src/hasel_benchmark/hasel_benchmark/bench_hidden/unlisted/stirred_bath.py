"""Not in the catalogue: a pump stirs the bath and pushes the rear of the body to and fro."""

from types import SimpleNamespace

import numpy as np
from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState

_START, _LENGTH = 0.1, 0.09
"""Where the stream begins to act, from the nose, and how long its reach is [m]."""


class StirredBath(ForceEffect):
    """A periodic force that has nothing to do with the drive."""

    id = "stirred_bath"
    physics = "A pump's pulsating stream pushes the rear of the body sideways."
    equation = "f = m g_s ((x - 0.1 m) / 0.09 m)_+ sin(2 pi f_s t)"
    parameters = (
        EffectParameter("acceleration", "g_s", "m/s^2", 0.0, 0.0, 5.0, 0.4),
        EffectParameter("frequency", "f_s", "1/s", 1.3, 0.1, 10.0, 1.3),
    )
    depends_on = ()

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per mass [N/kg], [n, 2]."""
        reach = np.clip((at.reference[:, 0] - _START) / _LENGTH, 0.0, 1.0)
        push = p.acceleration * np.sin(2 * np.pi * p.frequency * at.time) * reach
        return np.stack([np.zeros_like(push), push], axis=1)
