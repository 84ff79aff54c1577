"""Not in the catalogue: each muscle's electrodes slowly charge from the other's through a shared layer."""

from types import SimpleNamespace

import numpy as np
from hasel_sim.effects.base import DriveEffect, DriveStage, EffectParameter
from hasel_sim.effects.first_order_lag import first_order_lag


class ElectrodeLeakage(DriveEffect):
    """Cross-talk: the other muscle's voltage arrives late and weakened."""

    id = "electrode_leakage"
    physics = "Charge leaks from one muscle's electrodes to the other's through the layer between them."
    equation = "V_i <- V_i + kappa q_j, dq_j/dt = (V_j - q_j) / tau"
    parameters = (
        EffectParameter("coupling", "kappa", "1", 0.0, 0.0, 1.0, 0.4),
        EffectParameter("time", "tau", "s", 0.3, 0.01, 10.0, 0.3),
    )
    stage = DriveStage.ELECTRODE

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Voltage on the electrodes [V] with what has leaked over."""
        return signal + p.coupling * first_order_lag(time, signal, p.time, p.time)[:, ::-1]
