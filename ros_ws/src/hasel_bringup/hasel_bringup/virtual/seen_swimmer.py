# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The true swimmer as a camera with a clock of its own sees it: its angle, or where its markers are."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.live.live_simulator import Arrival, LiveAngle, LiveSimulator
from hasel_sim.model import Model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

from hasel_bringup.errors import BringupError


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
        """From the last state, whose voltage holds until then, to this one; nothing for one that is no later.

        Raises BringupError before a run.
        """
        if self.newest_ns is None:
            raise BringupError("No run has begun: begin one with its first state.")
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


class CameraNoise:
    """White noise plus noise shared by neighbouring frames (first-order autoregressive), each as rms of sin theta.

    correlation: of the shared part, from one frame to the next.
    """

    def __init__(self, white: float, coloured: float, correlation: float, seed: int) -> None:
        self._white, self._coloured, self._correlation = white, coloured, correlation
        self._generator = np.random.default_rng(seed)
        self._shared = coloured * self._generator.standard_normal()

    def next(self) -> float:
        """The noise of the next frame."""
        white, drive = self._generator.standard_normal(2)
        noise = self._white * white + self._shared
        fresh = self._coloured * np.sqrt(1 - self._correlation**2) * drive
        self._shared = self._correlation * self._shared + fresh
        return float(noise)


@dataclass(frozen=True)
class Exposure:
    """Where the markers are seen, [3, 2] [m], at a stamp [ns]."""

    stamp_ns: int
    markers: np.ndarray


class FilmedSwimmer:
    """Takes the supply's states in order and gives the exposures between them, one by one or for a whole run.

    ripple: how far [m rms, each axis] the water's surface displaces the picture of a marker.
    """

    def __init__(
        self, model: Model, frame_rate: float, ripple: float, generator: np.random.Generator
    ) -> None:
        self._live = LiveSimulator(model)
        self._clock = CameraClock(frame_rate)
        self._ripple, self._generator = ripple, generator
        self.put_back()

    def put_back(self) -> None:
        """Lay the swimmer straight and still in the middle of the picture, as is done between two runs."""
        self._live.restart()
        self._clock.end()
        self._middle = self._live.markers.mean(axis=0)

    def state(self, stamp_ns: int, voltage: np.ndarray) -> list[Exposure]:
        """The exposures since the last state; this one's voltage [V] holds from its stamp [ns] on.

        The first state begins the run, and one that comes late is ignored.
        """
        if self._clock.newest_ns is None:
            self._live.receive(stamp_ns, voltage)
            self._clock.begin(stamp_ns, voltage)
            return []
        exposures = []
        for instant in self._clock.until(stamp_ns, voltage):
            self._live.receive(instant.stamp_ns, instant.voltage)
            if instant.is_frame:
                exposures.append(Exposure(instant.stamp_ns, self._seen()))
        return exposures

    def film(self, states: Sequence[tuple[int, np.ndarray]]) -> list[Exposure]:
        """All exposures of a run that is over, from its states (stamp [ns], voltage [V]); several times as fast."""
        kept = _in_order(states)
        if len(kept) < 2:
            return []
        origin_ns, until_ns = kept[0][0], kept[-1][0]
        stamps = self._clock.frames(origin_ns, until_ns)[1:]
        if len(stamps) == 0:
            return []
        schedule = DriveSchedule(
            np.array([stamp - origin_ns for stamp, _ in kept]) * 1e-9,
            np.array([voltage for _, voltage in kept]),
        )
        simulation = simulate(self._live.model, Run("filmed", (stamps - origin_ns) * 1e-9, schedule))
        markers = simulation.markers - self._middle
        markers += self._ripple * self._generator.standard_normal(markers.shape)
        return [Exposure(int(stamp), each) for stamp, each in zip(stamps, markers, strict=True)]

    def _seen(self) -> np.ndarray:
        markers = self._live.markers - self._middle
        return markers + self._ripple * self._generator.standard_normal(markers.shape)


def _in_order(states: Sequence[tuple[int, np.ndarray]]) -> list[tuple[int, np.ndarray]]:
    kept: list[tuple[int, np.ndarray]] = []
    for stamp_ns, voltage in states:
        if not kept or stamp_ns > kept[-1][0]:
            kept.append((stamp_ns, voltage))
    return kept
