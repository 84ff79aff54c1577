"""Added mass of a body of finite depth: the fluid that goes around its edges and ends."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter, ForceEffect, SiteState
from hasel_sim.effects.slender import LineMotion, dot, finite_length_factor, strip_added_mass


class FiniteDepthAddedMass(ForceEffect):
    """Inertia of the fluid across the centre line, from the body's own depth and length."""

    id = "finite_depth_added_mass"
    physics = (
        "A body held in place carries fluid along as it swings, the more the deeper it is, less what escapes around "
        "its ends."
    )
    equation = (
        "f = -C_m (rho pi H / 4) / E(e) (a.n) n per length of the centre line and depth H, e^2 = 1 - (H / L)^2, "
        "E the complete elliptic integral"
    )
    parameters = (
        EffectParameter(
            "coefficient",
            "C_m",
            "1",
            0.0,
            0.0,
            2.0,
            1.0,
            "1 of an elliptic plate without viscosity (Lamb 1932), 1.2-1.5 with the oscillating layer at 0.5-2.5 Hz",
        ),
    )
    signature = "Every resonance drops by one factor; the phase falls behind most near resonance."
    confused_with = ("added_mass", "reactive_force", "soft_modulus", "payload", "spine_modulus")
    separated_by = "Ring-down in air and in the fluid on the same day; a static deflection is not changed."
    citation = "Lamb, Hydrodynamics, 6th ed. (1932), sections 71 and 114"
    needs_medium = True
    exclusive = "inertia of the fluid"
    sites = "line"
    depends_on = ("acceleration", "tangent")

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force per length and depth [N/m^2], [n, 2]."""
        fluid, normal = at.fluid, LineMotion.at(at).normal
        mass = p.coefficient * strip_added_mass(fluid) * finite_length_factor(fluid)
        return -mass * dot(at.acceleration, normal)[:, None] * normal
