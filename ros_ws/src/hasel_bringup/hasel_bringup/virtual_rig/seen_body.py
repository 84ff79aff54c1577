"""The simulated body, seen by a camera that has a clock of its own."""

import numpy as np
from hasel_sim.live.live_simulator import Arrival, LiveAngle, LiveSimulator
from hasel_sim.model import Model

from hasel_bringup.camera_clock import CameraClock


class SeenBody:
    """Takes the supply's states as they come and gives the angle at every frame that is over by then.

    frame_rate: frames per second, whatever the rate of the states; a new run's frames begin at its first state.
    """

    def __init__(self, model: Model, frame_rate: float) -> None:
        self._live = LiveSimulator(model)
        self._clock = CameraClock(frame_rate)
        self._frames: set[int] = set()

    def state(self, stamp_ns: int, voltage: np.ndarray) -> tuple[list[LiveAngle], str]:
        """Move on to a state's stamp [ns], from which its voltage [V] holds; the frames' angles and a sentence.

        The sentence tells what was out of the ordinary, as `LiveSimulator` does.
        """
        instants = self._clock.until(stamp_ns, voltage) if self._follows(stamp_ns) else []
        self._frames.update(instant.stamp_ns for instant in instants if instant.is_frame)
        angles: list[LiveAngle] = []
        for instant in instants[:-1]:
            angles += self._live.receive(instant.stamp_ns, instant.voltage).angles
        answer = self._live.receive(stamp_ns, voltage)
        if answer.arrival in (Arrival.START, Arrival.RESTART):
            self._frames = {self._clock.begin(stamp_ns, voltage).stamp_ns}
        return self._at_frames([*angles, *answer.angles]), answer.sentence

    def _follows(self, stamp_ns: int) -> bool:
        newest_ns = self._clock.newest_ns
        return newest_ns is not None and 0 < (stamp_ns - newest_ns) * 1e-9 <= self._live.order.reset

    def _at_frames(self, angles: list[LiveAngle]) -> list[LiveAngle]:
        seen = [angle for angle in angles if angle.stamp_ns in self._frames]
        self._frames -= {angle.stamp_ns for angle in seen}
        return seen
