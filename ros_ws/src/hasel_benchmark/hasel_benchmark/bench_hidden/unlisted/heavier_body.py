"""Not in the catalogue: the whole body is heavier than weighed."""

from types import SimpleNamespace

import numpy as np
from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState


class HeavierBody(ForceEffect):
    """Additional inertia in proportion to the body's own."""

    id = "heavier_body"
    physics = "Liquid soaked up by the body moves with it."
    equation = "f = -r m a"
    parameters = (EffectParameter("ratio", "r", "1", 0.0, -0.5, 1.0, 0.25),)
    depends_on = ("acceleration",)

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per mass [N/kg], [n, 2]."""
        return -p.ratio * at.acceleration
