"""Not in the catalogue: every stroke takes a step of strength from the next, however long it takes."""

from types import SimpleNamespace

import numpy as np
from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class TiredByStrokes(DriveEffect):
    """Contraction depends on the number of strokes so far, not on time."""

    id = "tired_by_strokes"
    physics = "Each stroke drains the supply's reservoir a little, so every stroke is weaker than the last."
    equation = "a <- a (1 - d)^(strokes of either muscle before)"
    parameters = (EffectParameter("loss", "d", "1", 0.0, 0.0, 0.3, 0.07),)
    stage = DriveStage.TARGET

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Contraction aimed at [1], smaller by a step at each switching on."""
        on = signal > 0
        strokes = np.sum(on & ~np.vstack([[False, False], on[:-1]]), axis=1)
        before = np.maximum(np.cumsum(strokes) - 1, 0)
        return signal * (1 - p.loss) ** before[:, None]
