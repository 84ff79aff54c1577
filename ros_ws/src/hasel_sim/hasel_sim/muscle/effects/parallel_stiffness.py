# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Parallel stiffness: films, seals and electrodes resist being bent into arcs."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter
from hasel_sim.muscle.effect import MuscleEffect


class ParallelStiffness(MuscleEffect):
    """A spring beside the pouches, slack at rest."""

    id = "parallel_stiffness"
    physics = "Films, seals and electrodes resist bending, so that the muscle itself opposes its contraction."
    equation = "F = F_pouch - k e, e the contraction by the rest length"
    parameters = (
        EffectParameter(
            "stiffness",
            "k",
            "N",
            0.0,
            0.0,
            200.0,
            5.0,
            "60 N identified for a 14-pouch muscle of 137 mm (published fit)",
        ),
    )
    signature = "Contraction falls short the more, the farther the muscle contracts."
    citation = "Yeh, Cisneros, Wu, Rabenorosoa, Le Gorrec, IEEE Robotics and Automation Letters 7 (2022) 7100"

    def opposing(self, strain: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Force [N]."""
        return p.stiffness * strain
