# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Series compliance: clamps, threads and the load cell give way."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import EffectParameter
from hasel_sim.muscle.effect import Held, MuscleEffect


class SeriesCompliance(MuscleEffect):
    """A spring between the pouches and the bench, shared out over the pouches."""

    id = "series_compliance"
    physics = "What holds the muscle gives way under force: clamps, seals between pouches, the load cell."
    equation = "give = c (F - F_rest) per pouch"
    parameters = (
        EffectParameter(
            "compliance", "c", "m/N", 0.0, 0.0, 5e-3, 1e-5, "load cells and threads, up to 5 mm/N (estimate)"
        ),
    )
    signature = "Nothing under a hanging load; less force where the contraction is held, in proportion to it."
    citation = "Hill, Proceedings of the Royal Society B 126 (1938) 136 (series elastic element)"

    def give(self, held: Held, p: SimpleNamespace) -> np.ndarray:
        """Stretch per pouch [m]."""
        return p.compliance * (held.force - held.rest_force)
