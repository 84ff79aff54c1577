"""A small library of safe experiments, in the words of the RunExperiment action."""

from dataclasses import asdict, dataclass
from itertools import product

import numpy as np
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.run import Run

_FRAME_RATE = 120.0
_RATES_HZ = (0.25, 0.5, 1.0, 1.5, 2.5, 3.5, 5.0)
_PERIODS, _LONGEST_S = 3, 6.0
_LOAD_FACTORS = (0.25, 0.5, 1.0, 2.0, 3.0)


@dataclass(frozen=True)
class Manoeuvre:
    """One experiment. voltage [V]; frequency [1/s]; waveform: box, triangle or sine; muscles: both, upper or lower.

    Each muscle is driven for a whole half period, with positive voltages only, which every supply can give; one muscle
    alone has the first half.

    load_factor: for a passive body, how many times its loads it is held under before it is let go.
    """

    voltage: float
    frequency: float
    periods: int
    waveform: str
    muscles: str
    load_factor: float | None = None

    def goal(self) -> dict:
        """Fields of a RunExperiment goal."""
        fields = {key: value for key, value in asdict(self).items() if key != "load_factor"}
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
        if self.waveform == "box":
            time = np.arange(0.0, duration - 1e-9, 0.5 / self.frequency)
            upper = np.arange(len(time)) % 2 == 0
            shape = np.stack([upper, ~upper], axis=1).astype(float)
        else:
            time = np.arange(0.0, duration, 1 / _FRAME_RATE)
            phase = (time * self.frequency) % 1.0
            wave = np.sin(2 * np.pi * phase) if self.waveform == "sine" else _triangle(phase)
            shape = np.stack([np.maximum(wave, 0.0), np.maximum(-wave, 0.0)], axis=1)
        if self.muscles != "both":
            alone = shape[:, 0]
            shape = np.zeros_like(shape)
            shape[:, 0 if self.muscles == "upper" else 1] = alone
        return DriveSchedule(time, self.voltage * shape)

    def __str__(self) -> str:
        if self.load_factor is not None:
            return f"hold under {self.load_factor:g} times its loads, let go"
        who = "both muscles" if self.muscles == "both" else f"the {self.muscles} muscle only"
        return (
            f"{self.waveform} of {self.voltage:g} V at {self.frequency:g} Hz, {self.periods} periods, {who}"
        )


def _triangle(phase: np.ndarray) -> np.ndarray:
    return 1 - 4 * np.abs(((phase + 0.25) % 1.0) - 0.5)


def manoeuvres(levels: np.ndarray, highest: float, brief: bool = False) -> list[Manoeuvre]:
    """All combinations within the safe maximum [V]; levels: voltages whose amplitudes are known [V], none: passive.

    brief: boxes at the highest of these voltages only.
    """
    if len(levels) == 0:
        return [Manoeuvre(0.0, 0.0, 0, "none", "both", factor) for factor in _LOAD_FACTORS]
    voltages = sorted({float(v) for v in (levels[0], levels[-1], min(highest, levels[-1])) if v <= highest})
    waveforms = ("box",) if brief else ("box", "triangle")
    return [
        Manoeuvre(voltage, rate, max(1, min(_PERIODS, int(_LONGEST_S * rate))), waveform, muscles)
        for voltage, rate, waveform, muscles in product(
            voltages[-1:] if brief else voltages, _RATES_HZ, waveforms, ("both", "upper")
        )
    ]
