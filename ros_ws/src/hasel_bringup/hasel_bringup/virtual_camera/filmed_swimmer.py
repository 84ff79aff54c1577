"""The true swimmer, moved on to every exposure of a camera that has a clock of its own."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.live.live_simulator import LiveSimulator
from hasel_sim.model import Model
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

from hasel_bringup.camera_clock import CameraClock


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
