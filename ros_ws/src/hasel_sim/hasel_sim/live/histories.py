# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The recent past of a running simulation: what drove it, and the angle that was observed."""

import numpy as np
from hasel_recording.recording import row_in_force

from hasel_sim.drive.chain import DriveChain
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import ObservationEffect
from hasel_sim.mechanics.state import DriveState
from hasel_sim.model import Model
from hasel_sim.model_mesh import observe


class Window:
    """Rows of any shape with their times [s], kept for `span` seconds before the newest."""

    def __init__(self, span: float) -> None:
        self.span = span
        self.time = np.empty(0)
        self.rows = np.empty(0)

    def __len__(self) -> int:
        return len(self.time)

    def add(self, time: np.ndarray, rows: np.ndarray) -> None:
        """Append rows [n, …] at ascending times [s] [n] and drop what is too old."""
        if len(self.time) == 0:
            self.rows = np.empty((0, *rows.shape[1:]))
        first = np.searchsorted(self.time, time[-1] - self.span)
        self.time = np.concatenate([self.time[first:], time])
        self.rows = np.concatenate([self.rows[first:], rows])


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

    @property
    def changed_at(self) -> float:
        """When the voltage changed last [s]; the start where it has not."""
        return float(self._schedule.time[-1]) if len(self._schedule.time) else self._start

    def wait(self, times: np.ndarray) -> None:
        """Let the next instants [s] [n] pass without asking what they lead to."""
        self._instants.add(times, np.empty((len(times), 0)))

    def advance(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Voltage [V] and contraction [1], both [n, muscles], at the next instants [s] [n]; 0 V where none is known."""
        if len(self._schedule.time) == 0:
            self.hold(self._start, np.zeros(len(self._schedule.channels)))
        self.wait(times)
        voltage = self._chain.at_muscles(self._schedule.at(times))
        instants = np.concatenate([[self._start], self._instants.time])
        kept = self._sharp[self._sharp > self._instants.time[0]]
        instants = self._sharp = self._chain.sharpened(
            self._schedule, np.union1d(instants, kept), self._values, self._effect_values
        )
        contraction = self._chain.contraction_on(self._schedule, instants, self._values, self._effect_values)
        return voltage, contraction[np.searchsorted(instants, times)]


class AngleHistory:
    """Marker positions of the last `history` seconds and the angle measured from them.

    An effect that looks ahead (a camera whose clock is early) delays the answer by as much.
    """

    def __init__(self, model: Model, history: float) -> None:
        self._seen = Window(history)
        self._waiting: list[tuple[int, float]] = []
        self.use(model)

    def use(self, model: Model) -> None:
        """Go on with another model's observation effects."""
        self._effects = [effect for effect in model.effects if isinstance(effect, ObservationEffect)]
        self._values = model.effect_values()
        self._ahead = max([0.0, *(e.look_ahead(self._values[e.id]) for e in self._effects)])

    def add(self, times: np.ndarray, markers: np.ndarray, across: np.ndarray) -> None:
        """Append marker positions [m] and lines across the body [n, 3, 2] at times [s] [n]."""
        self._seen.add(times, np.stack([markers, across], axis=1))

    def expect(self, stamp_ns: int, time: float) -> None:
        """Ask for the angle at a frame; `time` [s] is one of those added."""
        self._waiting.append((stamp_ns, time))

    def ready(self) -> list[tuple[int, float]]:
        """Stamps [ns] and sin theta of the frames asked for that can be told by now."""
        if self._effects and len(self._seen) < 2:
            return []  # an effect needs a series; one instant is none
        newest = self._seen.time[-1] + 1e-9
        due = [frame for frame in self._waiting if frame[1] + self._ahead <= newest]
        if not due:
            return []
        self._waiting = self._waiting[len(due) :]
        first = 0 if self._effects else int(np.searchsorted(self._seen.time, due[0][1]))
        time, rows = self._seen.time[first:], self._seen.rows[first:]
        series = observe(time, rows[:, 0], rows[:, 1], self._effects, self._values)
        indices = np.minimum(np.searchsorted(time, [at for _, at in due]), len(time) - 1)
        return [(stamp, float(series[index])) for (stamp, _), index in zip(due, indices, strict=True)]
