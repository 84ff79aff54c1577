"""The whole drive: commanded voltage -> supply and electrode effects -> target -> slope -> contraction."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.drive.sloped_box import limit_rate, target_contraction
from hasel_sim.drive.voltage import VoltageSchedule
from hasel_sim.effects.base import DriveEffect, DriveStage


class DriveChain:
    """Contraction of both muscles for given parameter values; effects act in the order of their stage, then id.

    levels: voltages [V] that have an amplitude of their own; a parameter `amplitude_<level>` belongs to each.
    """

    def __init__(self, effects: list[DriveEffect], levels: np.ndarray) -> None:
        self.effects = sorted(effects, key=lambda effect: (effect.stage, effect.id))
        self.levels = np.asarray(levels, dtype=float)

    def contraction(
        self, schedule: VoltageSchedule, times: np.ndarray, values: dict[str, float], effect_values: dict
    ) -> np.ndarray:
        """Contraction [1] [n, 2] at ascending times [s] [n].

        values: the baseline's `slope` [1/s] and `amplitude_<level>`; effect_values: a namespace per effect id.
        """
        time, signal = schedule.sampled(times)
        amplitudes = np.array([values[f"amplitude_{level:g}"] for level in self.levels])
        for stage in DriveStage:
            if stage == DriveStage.TARGET:
                signal = target_contraction(signal, self.levels, amplitudes)
            if stage == DriveStage.CONTRACTION:
                signal = limit_rate(time, signal, values["slope"])
            for effect in self.effects:
                if effect.stage == stage:
                    p: SimpleNamespace = effect_values[effect.id]
                    signal = effect.respond(time, signal, p)
                    time = effect.clock(time, p)
        return np.stack([np.interp(times, time, signal[:, muscle]) for muscle in range(2)], axis=1)
