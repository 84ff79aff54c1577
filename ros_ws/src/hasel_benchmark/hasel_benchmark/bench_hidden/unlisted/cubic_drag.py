"""Not in the catalogue: drag with another exponent than one or two."""

from types import SimpleNamespace

import numpy as np
from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState


class CubicDrag(ForceEffect):
    """Drag that grows with the third power of the normal velocity."""

    id = "cubic_drag"
    physics = "Waves carry energy away from the moving surface, the more the faster it moves."
    equation = "f = -c abs(v.n)^2 (v.n) n per skin length"
    parameters = (EffectParameter("coefficient", "c", "N s^3/m^5", 0.0, 0.0, 1e5, 500.0),)
    sites = "skin"
    depends_on = ("velocity", "tangent")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per skin length [N/m^2], [n, 2]."""
        speed = np.sum(at.velocity * at.normal, axis=1)
        return (-p.coefficient * speed**3)[:, None] * at.normal
