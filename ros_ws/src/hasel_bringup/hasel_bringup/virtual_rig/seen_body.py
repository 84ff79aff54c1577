"""The simulated body, seen by a camera that has a clock of its own."""

import numpy as np
from hasel_sim.live.live_simulator import LiveAngle, LiveSimulator
from hasel_sim.live.stamp_order import Arrival
from hasel_sim.model import Model


class SeenBody:
    """Takes the supply's states as they come and gives the angle at every frame that is over by then.

    frame_rate: frames per second, whatever the rate of the states; a new run's frames begin at its first state.
    """

    _newest_ns: int | None
    _next_ns: int
    _voltage: np.ndarray
    _frames: set[int]

    def __init__(self, model: Model, frame_rate: float) -> None:
        self._live = LiveSimulator(model)
        self._period_ns = round(1e9 / frame_rate)
        self._begin(None, np.zeros(len(model.channels)))

    def state(self, stamp_ns: int, voltage: np.ndarray) -> tuple[list[LiveAngle], str]:
        """Move on to a state's stamp [ns], from which its voltage [V] holds; the frames' angles and a sentence.

        The sentence tells what was out of the ordinary, as `LiveSimulator` does.
        """
        angles: list[LiveAngle] = []
        if self._follows(stamp_ns):
            while self._next_ns < stamp_ns:
                self._frames.add(self._next_ns)
                angles += self._live.receive(self._next_ns, self._voltage).angles
                self._next_ns += self._period_ns
        if self._next_ns == stamp_ns:
            self._frames.add(stamp_ns)
            self._next_ns += self._period_ns
        answer = self._live.receive(stamp_ns, voltage)
        if answer.arrival in (Arrival.START, Arrival.RESTART):
            self._begin(stamp_ns, voltage)
        elif answer.arrival is not Arrival.HELD:
            self._newest_ns, self._voltage = stamp_ns, voltage
        return self._at_frames([*angles, *answer.angles]), answer.sentence

    def _follows(self, stamp_ns: int) -> bool:
        if self._newest_ns is None:
            return False
        return 0 < (stamp_ns - self._newest_ns) * 1e-9 <= self._live.order.reset

    def _begin(self, stamp_ns: int | None, voltage: np.ndarray) -> None:
        self._newest_ns, self._voltage = stamp_ns, voltage
        self._frames = set() if stamp_ns is None else {stamp_ns}
        self._next_ns = 0 if stamp_ns is None else stamp_ns + self._period_ns

    def _at_frames(self, angles: list[LiveAngle]) -> list[LiveAngle]:
        seen = [angle for angle in angles if angle.stamp_ns in self._frames]
        self._frames -= {angle.stamp_ns for angle in seen}
        return seen
