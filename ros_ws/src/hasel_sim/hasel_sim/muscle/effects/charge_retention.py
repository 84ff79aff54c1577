# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Charge retention: charge creeps into the film and shields part of the field."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.drive.charge_retention import ChargeRetention as OfTheDrive
from hasel_sim.muscle.effect import MuscleEffect


class PouchChargeRetention(MuscleEffect):
    """The drive's effect of this name, on the bench."""

    id = OfTheDrive.id
    physics = OfTheDrive.physics
    equation = OfTheDrive.equation
    parameters = OfTheDrive.parameters
    signature = "Contraction fades while one polarity is held, and not when it alternates; some is left after release."
    citation = OfTheDrive.citation
    in_time = True

    def electrodes(self, time: np.ndarray, voltage: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Effective voltage [V]."""
        return OfTheDrive().respond(time, voltage[:, None], p)[:, 0]
