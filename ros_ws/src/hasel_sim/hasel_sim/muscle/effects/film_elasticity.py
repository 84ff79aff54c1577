# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Film elasticity: the films stretch under their tension."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter
from hasel_sim.muscle.effect import Held, MuscleEffect

_STEEPEST = 0.02
"""Smallest cosine: a film that is nearly upright carries no load by its tension."""


class FilmElasticity(MuscleEffect):
    """Each film carries half of the force; in the arcs it is pulled at their angle."""

    id = "film_elasticity"
    physics = "The films stretch: each carries half of the force, and more in the arcs, which it leaves at their angle."
    equation = "give = N (l_e + l_p / cos alpha) c F / (2 t w), less its value at rest"
    parameters = (
        EffectParameter(
            "compliance",
            "c",
            "1/Pa",
            0.0,
            0.0,
            5e-9,
            3e-10,
            "1/E of stretched polypropylene or polyester, 2 to 5 GPa",
        ),
    )
    signature = "Contraction falls short in proportion to force, most near full contraction."
    citation = "Rothemund, Kirkman, Keplinger, PNAS 117 (2020) 16207 (inextensible limit)"

    def give(self, held: Held, p: SimpleNamespace) -> np.ndarray:
        """Stretch per pouch [m]."""
        pouch = held.pouch
        share = p.compliance / (2 * pouch.film_thickness * pouch.width)
        slope = np.maximum(np.cos(held.angle), _STEEPEST)
        now = (pouch.zipped(held.angle) + pouch.arc(held.angle) / slope) * held.force
        return share * (now - pouch.film_length / np.cos(pouch.relaxed_angle) * held.rest_force)
