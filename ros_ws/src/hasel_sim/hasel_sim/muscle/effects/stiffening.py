# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Stiffening: wrinkles and side seals resist large contractions more than in proportion."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter
from hasel_sim.muscle.effect import MuscleEffect


class Stiffening(MuscleEffect):
    """A resistance that grows with the square of the contraction."""

    id = "stiffening"
    physics = "Film that must wrinkle beside the seals, and oil pressed into corners, resist large contractions most."
    equation = "F = F_pouch - k_2 e^2, e the contraction by the rest length"
    parameters = (
        EffectParameter(
            "stiffness", "k_2", "N", 0.0, 0.0, 2000.0, 50.0, "nonlinear springs of curling HASELs (estimate)"
        ),
    )
    signature = "As designed at small contractions, short of it at large ones."
    citation = "Yeh, Cisneros, Wu, Rabenorosoa, Le Gorrec, IEEE Robotics and Automation Letters 7 (2022) 7100"

    def opposing(self, strain: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Force [N]."""
        return p.stiffness * np.square(strain)
