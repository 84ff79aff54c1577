"""The drive chain of a running simulation, evaluated over the recent past."""

import numpy as np

from hasel_sim.drive.chain import DriveChain
from hasel_sim.drive.voltage import VoltageSchedule
from hasel_sim.effects.base import DriveEffect
from hasel_sim.live.window import Window
from hasel_sim.model import Model


class DriveHistory:
    """Voltages received and the contraction they lead to.

    The chain works on whole series. It is evaluated anew over the last `history` seconds at every step, on the instants
    that a simulation of the whole run would use: as long as the run is not longer than that, both agree exactly. In a
    longer run, effects that remember more than `history` seconds take what was before for a rest at 0 V; the start of
    the run is never forgotten.
    """

    def __init__(self, model: Model, history: float, start: float) -> None:
        self._history, self._start = history, start
        self._instants = Window(history)
        self._schedule = VoltageSchedule(np.empty(0), np.empty((0, 2)))
        self.use(model)

    def use(self, model: Model) -> None:
        """Go on with another model's muscles and drive effects."""
        effects = [effect for effect in model.effects if isinstance(effect, DriveEffect)]
        self._chain = DriveChain(effects, model.levels) if model.has_muscles else None
        self._values, self._effect_values = model.values, model.effect_values()

    def hold(self, time: float, voltage: np.ndarray) -> None:
        """Apply a voltage [V] [2] from `time` [s] on."""
        schedule = self._schedule
        if len(schedule.time) and np.array_equal(schedule.voltage[-1], voltage):
            return
        in_force = int(np.searchsorted(schedule.time, time - self._history, side="right")) - 1
        first = max(0, in_force)
        self._schedule = VoltageSchedule(
            np.append(schedule.time[first:], time), np.vstack([schedule.voltage[first:], voltage])
        )

    def advance(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Voltage [V] and contraction [1], both [n, 2], at the next instants [s] [n]."""
        self._instants.add(times, np.empty((len(times), 0)))
        voltage = self._schedule.at(times)
        if self._chain is None:
            return voltage, np.zeros((len(times), 2))
        instants = np.concatenate([[self._start], self._instants.time])
        contraction = self._chain.contraction(self._schedule, instants, self._values, self._effect_values)
        return voltage, contraction[-len(times) :]
