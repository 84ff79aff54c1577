"""Not in the catalogue: the lower muscle does not move below a threshold voltage."""

from types import SimpleNamespace

import numpy as np
from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter


class OneSidedDeadZone(DriveEffect):
    """A threshold in voltage of one muscle only."""

    id = "one_sided_dead_zone"
    physics = "The lower pouch's film sticks and zips only once the field has pulled it loose."
    equation = "V_lower <- sign(V_lower) max(0, abs(V_lower) - V_0)"
    parameters = (EffectParameter("threshold", "V_0", "V", 0.0, 0.0, 3000.0, 500.0),)
    stage = DriveStage.ZIPPING

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Voltage [V] that the zipped state corresponds to."""
        lower = np.sign(signal[:, 1]) * np.maximum(np.abs(signal[:, 1]) - p.threshold, 0.0)
        return np.stack([signal[:, 0], lower], axis=1)
