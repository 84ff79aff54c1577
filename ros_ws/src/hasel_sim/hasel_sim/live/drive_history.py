"""The drive chain of a running simulation, evaluated over the recent past."""

import numpy as np
from hasel_recording.zero_order_hold import row_in_force

from hasel_sim.drive.chain import DriveChain
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.live.window import Window
from hasel_sim.mechanics.state import DriveState
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
        self._schedule = DriveSchedule(np.empty(0), np.empty((0, len(model.channels))), model.channels)
        self.use(model)

    def use(self, model: Model) -> None:
        """Go on with another model's muscles and drive effects."""
        self._chain = DriveChain(model)
        self._sharp = np.empty(0)
        self._values, self._effect_values = model.values, model.effect_values()

    @property
    def still(self) -> DriveState:
        """The muscles before anything is commanded."""
        return DriveState.single(np.zeros(self._chain.count), self._chain.relaxed, self._start)

    def hold(self, time: float, voltage: np.ndarray) -> None:
        """Apply a voltage [V] [channels] from `time` [s] on."""
        schedule = self._schedule
        if len(schedule.time) and np.array_equal(schedule.signal[-1], voltage):
            return
        first = max(0, int(row_in_force(schedule.time, time - self._history)))
        self._schedule = DriveSchedule(
            np.append(schedule.time[first:], time),
            np.vstack([schedule.signal[first:], voltage]),
            schedule.channels,
        )

    def advance(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Voltage [V] and contraction [1], both [n, muscles], at the next instants [s] [n]; 0 V where none is known."""
        if len(self._schedule.time) == 0:
            self.hold(self._start, np.zeros(len(self._schedule.channels)))
        self._instants.add(times, np.empty((len(times), 0)))
        voltage = self._chain.at_muscles(self._schedule.at(times))
        instants = np.concatenate([[self._start], self._instants.time])
        kept = self._sharp[self._sharp > self._instants.time[0]]
        instants = self._sharp = self._chain.sharpened(
            self._schedule, np.union1d(instants, kept), self._values, self._effect_values
        )
        contraction = self._chain.contraction_on(self._schedule, instants, self._values, self._effect_values)
        return voltage, contraction[np.searchsorted(instants, times)]
