"""A small library of safe experiments, in the words of the RunExperiment action."""

from dataclasses import dataclass
from itertools import product

import numpy as np
from hasel_recording import HASEL_PAIR, DriveChannel
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.run import Run

_FRAME_RATE = 120.0
_RATES_HZ = (0.25, 0.5, 1.0, 1.5, 2.5, 3.5, 5.0)
_PERIODS, _LONGEST_S = 3, 6.0
_LOAD_FACTORS = (0.25, 0.5, 1.0, 2.0, 3.0)


@dataclass(frozen=True)
class Manoeuvre:
    """One experiment. voltage: largest value of the drive, in the unit of its channels; frequency [1/s]; waveform: box,
    triangle or sine; muscles: both (all channels in turn) or the name of one.

    Each channel is driven for its share of the period, with positive values only, which every supply can give; one
    alone has the first half.

    load_factor: for a passive body, how many times its loads it is held under before it is let go; channels: what
    drives the body, all of one unit.
    """

    voltage: float
    frequency: float
    periods: int
    waveform: str
    muscles: str
    load_factor: float | None = None
    channels: tuple[DriveChannel, ...] = HASEL_PAIR

    def goal(self) -> dict:
        """Fields of a RunExperiment goal; for channels other than the rig's two voltages, the same in their unit."""
        fields = {key: getattr(self, key) for key in ("frequency", "periods", "waveform")}
        if self.channels != HASEL_PAIR:
            driven = [c.column for c in self.channels if self.muscles in ("both", c.name)]
            return {"level": self.voltage, "unit": self.channels[0].unit, **fields, "channels": driven}
        fields |= {"voltage": self.voltage, "muscles": self.muscles}
        return {**fields, "polarity": "positive", "duty": 1.0, "rest_time": 2.0, "output": ""}

    def run(self) -> Run:
        """The run to simulate."""
        if self.load_factor is not None:
            time = np.arange(0.0, 4.0, 1 / _FRAME_RATE)
            return Run(str(self), time, None, "static_equilibrium", self.load_factor)
        duration = self.periods / self.frequency
        time = np.arange(0.0, duration, 1 / _FRAME_RATE)
        return Run(str(self), time, self._schedule(duration))

    def _schedule(self, duration: float) -> DriveSchedule:
        names = [channel.name for channel in self.channels]
        alone = None if self.muscles == "both" else names.index(self.muscles)
        count = 2 if alone is not None else max(2, len(names))
        if self.waveform == "box":
            time = np.arange(0.0, duration - 1e-9, 1 / (count * self.frequency))
            turns = (np.arange(len(time)) % count)[:, None] == np.arange(count)
        else:
            time = np.arange(0.0, duration, 1 / _FRAME_RATE)
            turn = count * ((time * self.frequency) % 1.0)
            wave = np.sin(np.pi * (turn % 1.0)) if self.waveform == "sine" else _triangle(turn % 1.0)
            turns = wave[:, None] * (np.floor(turn)[:, None] == np.arange(count))
        shape = np.zeros((len(time), len(names)))
        if alone is None:
            shape[:] = turns[:, : len(names)]
        else:
            shape[:, alone] = turns[:, 0]
        return DriveSchedule(time, self.voltage * shape, tuple(names))

    def __str__(self) -> str:
        if self.load_factor is not None:
            return f"hold under {self.load_factor:g} times its loads, let go"
        size = self.channels[0].shown(self.voltage)
        return f"{self.waveform} of {size} at {self.frequency:g} Hz, {self.periods} periods, {self._who()}"

    def _who(self) -> str:
        names = [channel.name for channel in self.channels]
        if self.channels == HASEL_PAIR:
            return "both muscles" if self.muscles == "both" else f"the {self.muscles} muscle only"
        if self.muscles == "both" and len(names) > 1:
            return f"{', '.join(names)} in turn"
        return f"{names[0] if self.muscles == 'both' else self.muscles} only"


def _triangle(share: np.ndarray) -> np.ndarray:
    """From 0 to 1 and back over a turn, by the share of it that has passed."""
    return 1 - np.abs(2 * share - 1)


def manoeuvres(
    levels: np.ndarray, highest: float, brief: bool = False, channels: tuple[DriveChannel, ...] = HASEL_PAIR
) -> list[Manoeuvre]:
    """All combinations within the safe maximum; levels: those whose amplitudes are known, none: a passive body.

    levels, highest: in the unit of the channels; brief: boxes at the highest of these levels only.
    """
    if len(levels) == 0:
        return [Manoeuvre(0.0, 0.0, 0, "none", "both", factor) for factor in _LOAD_FACTORS]
    voltages = sorted({float(v) for v in (levels[0], levels[-1], min(highest, levels[-1])) if v <= highest})
    waveforms = ("box",) if brief else ("box", "triangle")
    driven = ("both", channels[0].name) if len(channels) > 1 else ("both",)
    return [
        Manoeuvre(
            voltage, rate, max(1, min(_PERIODS, int(_LONGEST_S * rate))), waveform, muscles, channels=channels
        )
        for voltage, rate, waveform, muscles in product(
            voltages[-1:] if brief else voltages, _RATES_HZ, waveforms, driven
        )
    ]
