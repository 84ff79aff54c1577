"""The measured angle of a running simulation, observed over the recent past."""

import numpy as np

from hasel_sim.effects.base import ObservationEffect
from hasel_sim.live.window import Window
from hasel_sim.model import Model
from hasel_sim.observation import observe


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
