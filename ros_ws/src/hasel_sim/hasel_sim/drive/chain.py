"""The whole drive: commanded signal -> supply and electrode effects -> target -> response -> contraction."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.drive.peano_hasel import PeanoHaselDrive
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.drive.sloped_box import limit_rate, target_contraction
from hasel_sim.effects.base import DriveEffect, DriveStage
from hasel_sim.effects.first_order_lag import first_order_lag
from hasel_sim.model import Model


class DriveChain:
    """Contraction of every muscle for given parameter values; effects act in the order of their stage, then id."""

    def __init__(self, model: Model) -> None:
        effects = [effect for effect in model.effects if isinstance(effect, DriveEffect)]
        self.effects = sorted(effects, key=lambda effect: (effect.stage, effect.id))
        self.channels = model.channels
        self._of_muscle = model.muscle_channels
        self._rest = np.array([muscle.rest_contraction for muscle in model.described.muscles])
        self._response = model.description.muscle_response
        law = model.description.muscle
        self._law = PeanoHaselDrive(law) if law else None
        self._by_law = [column for column, name in enumerate(self.channels) if model.follows_law(name)]
        self._tables = []
        for table in model.tables:
            columns = [self.channels.index(name) for name in table.channels]
            levels = table.levels(model.parameters)
            self._tables.append((columns, levels, [table.name(level) for level in levels]))

    @property
    def count(self) -> int:
        """How many muscles there are."""
        return len(self._of_muscle)

    @property
    def relaxed(self) -> np.ndarray:
        """Contraction [muscles] when nothing is commanded."""
        return self._rest

    def at_muscles(self, signal: np.ndarray) -> np.ndarray:
        """What drives each muscle [n, muscles], from what is commanded on the channels [n, channels]."""
        return signal[:, self._of_muscle]

    def contraction(
        self, schedule: DriveSchedule, times: np.ndarray, values: dict[str, float], effect_values: dict
    ) -> np.ndarray:
        """Contraction [1] [n, muscles] at ascending times [s] [n], its value at rest included.

        schedule: of exactly this body's channels; values: the baseline's response and amplitudes; effect_values: a
        namespace per effect id.
        """
        if self.count == 0:
            return np.zeros((len(times), 0))
        time, signal = schedule.sampled(times)
        for stage in DriveStage:
            if stage == DriveStage.ELECTRODE and self._response == "first_order":
                signal = first_order_lag(time, signal, values["rise_time"], values["fall_time"])
            if stage == DriveStage.TARGET:
                signal = self._target(signal, values)
            if stage == DriveStage.CONTRACTION and self._response == "sloped_box":
                signal = limit_rate(time, signal, values["slope"])
            for effect in self.effects:
                if effect.stage == stage:
                    p: SimpleNamespace = effect_values[effect.id]
                    signal = effect.respond(time, signal, p)
                    time = effect.clock(time, p)
        series = [np.interp(times, time, signal[:, muscle]) for muscle in range(self.count)]
        return self._rest + np.stack(series, axis=1)

    def _target(self, signal: np.ndarray, values: dict[str, float]) -> np.ndarray:
        """Contraction aimed at [n, muscles] for a drive [n, channels]."""
        aimed = np.zeros_like(signal, dtype=float)
        if self._law is not None:
            aimed[:, self._by_law] = self._law.contraction(signal[:, self._by_law], values)
        for columns, levels, names in self._tables:
            amplitudes = np.array([values[name] for name in names])
            aimed[:, columns] = target_contraction(signal[:, columns], levels, amplitudes)
        return aimed[:, self._of_muscle]
