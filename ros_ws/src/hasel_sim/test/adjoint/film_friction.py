# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A law whose stress changes with the rate of the deformation by no symmetric matrix, as none of the catalogue does."""

from hasel_sim.effects.base import EffectParameter, MaterialEffect
from hasel_sim.mesh.mesh import Region


class FilmFriction(MaterialEffect):
    """Shearing pulls at the muscles' film."""

    depends_on = ("deformation", "rate")
    regions = (Region.UPPER_MUSCLE, Region.LOWER_MUSCLE)
    parameters = (EffectParameter("eta", "eta", "Pa s", 0.0, 0.0, 1e5, 2e3),)
    physics = "The film of the muscles resists being stretched, and pulls where it is sheared."
    equation = "tension += eta (dF11/dt + dF12/dt)"

    def first_piola(self, at, p):
        """Along the fibre."""
        sheared = at.rate[:, 0, 1]
        return at.along_fibre(p.eta * (at.rate[:, 0, 0] + sheared))
