"""Frames of a camera with a clock of its own, among the states of a supply."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Instant:
    """stamp_ns: of a frame, or of a state between frames; voltage: [channels] [V], that holds from then on."""

    stamp_ns: int
    voltage: np.ndarray
    is_frame: bool


class CameraClock:
    """Gives the instants that a body is moved on to from one state to the next: every frame, then the state itself."""

    _voltage: np.ndarray
    _next_ns: int

    def __init__(self, frame_rate: float) -> None:
        self._period_ns = round(1e9 / frame_rate)
        self.newest_ns: int | None = None
        """Stamp of the last state; None before a run."""

    def begin(self, stamp_ns: int, voltage: np.ndarray) -> Instant:
        """Begin a run with a state [ns] and its voltage [V]: its first frame."""
        self.newest_ns, self._next_ns = stamp_ns, stamp_ns + self._period_ns
        self._voltage = voltage
        return Instant(stamp_ns, voltage, True)

    def end(self) -> None:
        """The next state begins a run."""
        self.newest_ns = None

    def until(self, stamp_ns: int, voltage: np.ndarray) -> list[Instant]:
        """From the last state, whose voltage holds until then, to this one; nothing for one that is no later."""
        if stamp_ns <= self.newest_ns:
            return []
        frames = self.frames(self._next_ns, stamp_ns)
        between = [Instant(int(frame), self._voltage, True) for frame in frames if frame < stamp_ns]
        self.newest_ns, self._voltage = stamp_ns, voltage
        self._next_ns += self._period_ns * len(frames)
        return [*between, Instant(stamp_ns, voltage, len(frames) > len(between))]

    def frames(self, first_ns: int, until_ns: int) -> np.ndarray:
        """Stamps [ns] of all frames from one of them to an instant, which may be the last of them."""
        return np.arange(first_ns, until_ns + 1, self._period_ns)
