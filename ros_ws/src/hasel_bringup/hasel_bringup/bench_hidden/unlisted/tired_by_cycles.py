"""Not in the catalogue: a muscle loses a step of stroke each time it is switched on, however long that takes."""

from types import SimpleNamespace

import numpy as np
from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class TiredByCycles(DriveEffect):
    """Stroke depends on the number of the cycle, not on time."""

    id = "tired_by_cycles"
    physics = (
        "Each zipping squeezes some liquid past a leaking seal, so every stroke is smaller than the last."
    )
    equation = "a <- a (1 - loss)^(times switched on before)"
    parameters = (EffectParameter("loss", "d", "1", 0.0, -0.3, 0.3, 0.1),)
    stage = DriveStage.TARGET

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction aimed at [1], smaller by a step at each switching on."""
        on = signal > 0
        rises = on & ~np.vstack([[False, False], on[:-1]])
        return signal * (1 - p.loss) ** np.maximum(np.cumsum(rises, axis=0) - 1, 0)
