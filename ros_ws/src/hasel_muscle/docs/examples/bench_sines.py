# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A load that hangs from a muscle under sines of the voltage: what a bench saw, and what the muscle's law says.

`bench_muscle` compares lifts. This takes the muscle and the swing that it found to recordings of sines, which it never
fitted: every stretch of a steady sine by its frequency and highest voltage, with the contraction's peak to peak and its
parts at the sine's frequency and at half of it. Half the frequency is that of a load that beats once in two periods, as
it may where the voltage changes the muscle's stiffness at twice the load's own frequency.

    ros2 run hasel_muscle bench_muscle 60g__step….mat --json found.json --output found
    python bench_sines.py found/muscle.yaml found.json 60g__sin….mat …
"""

import json
import sys
from collections.abc import Iterator
from dataclasses import astuple, dataclass
from pathlib import Path

import numpy as np
from hasel_muscle.bench_files import read_bench
from hasel_muscle.bench_recording import BenchRecording
from hasel_sim.model.muscle_file import load_muscle
from hasel_sim.muscle.muscle import Muscle
from hasel_sim.muscle.swing import HangingLoad

WINDOW_S = 1.0
"""A sine is steady where its frequency and highest voltage stay for three of these; what leads up to it is left out."""
_SAME = 0.02


@dataclass(frozen=True)
class SineBeat:
    """Mean, peak to peak, and amplitudes at the frequency and at half of it, of a contraction [m]."""

    mean: float
    peak_to_peak: float
    once: float
    half: float

    @staticmethod
    def of(time: np.ndarray, x: np.ndarray, frequency: float) -> "SineBeat":
        """That of a series; what was not seen (NaN) counts as the mean."""
        mean = float(np.nanmean(x))
        away = np.nan_to_num(x - mean)
        window = np.hanning(len(time))

        def at(f: float) -> float:
            return float(2 * abs(np.sum(window * away * np.exp(-2j * np.pi * f * time))) / window.sum())

        return SineBeat(mean, float(np.ptp(away)), at(frequency), at(frequency / 2))


@dataclass(frozen=True)
class SineStretch:
    """A steady sine in a recording: frequency [Hz], highest voltage [V], what was measured and what the law says."""

    frequency: float
    highest: float
    measured: SineBeat
    simulated: SineBeat

    def __str__(self) -> str:
        pairs = zip(astuple(self.measured), astuple(self.simulated), strict=True)
        told = "".join(f" | {1e3 * seen:6.2f} {1e3 * said:6.2f}" for seen, said in pairs)
        return f"{self.frequency:5.1f} Hz to {self.highest:4.0f} V{told}"


def stretches(recording: BenchRecording, muscle: Muscle, swing: dict[str, float]) -> list[SineStretch]:
    """All steady sines of a recording; swing: damping, slowness and lag as of `HangingLoad`."""
    load, largest = float(np.nanmedian(recording.load)), float(np.abs(recording.voltage).max())
    x = HangingLoad(muscle, load, largest, **swing).contraction(recording.time, recording.voltage)
    first = np.flatnonzero(np.abs(recording.voltage) > _SAME * largest)[0]
    measured = recording.contraction - np.nanmedian(recording.contraction[: max(first, 1)])
    out = []
    for frequency, highest, frames in _steady(recording):
        time = recording.time[frames]
        beats = (SineBeat.of(time, series[frames], frequency) for series in (measured, x))
        out.append(SineStretch(frequency, highest, *beats))
    return out


def _steady(recording: BenchRecording) -> Iterator[tuple[float, float, np.ndarray]]:
    """Frequency [Hz], highest voltage [V] and frames of every steady sine."""
    windows = []
    for begin in np.arange(recording.time[0], recording.time[-1] - WINDOW_S, WINDOW_S):
        frames = np.flatnonzero((recording.time >= begin) & (recording.time < begin + WINDOW_S))
        windows.append((*_sine(recording.time[frames], recording.voltage[frames]), frames))
    while windows:
        frequency, highest, _ = windows[0]
        same = 1
        while same < len(windows) and np.allclose(windows[same][:2], (frequency, highest), rtol=_SAME):
            same += 1
        if frequency > 0 and same > 3:
            yield float(f"{frequency:.3g}"), highest, np.concatenate([w[2] for w in windows[2:same]])
        windows = windows[same:]


def _sine(time: np.ndarray, voltage: np.ndarray) -> tuple[float, float]:
    """Frequency and highest value of one period or more; no frequency where it is held, or switched."""
    highest, middle = float(voltage.max()), 0.5 * float(voltage.max() + voltage.min())
    up = np.flatnonzero((voltage[:-1] < middle) & (voltage[1:] >= middle))
    if np.ptp(voltage) <= _SAME * abs(highest) or np.abs(np.diff(voltage)).max() > 0.2 * np.ptp(voltage):
        return 0.0, highest
    return (1 / WINDOW_S if len(up) < 2 else (len(up) - 1) / (time[up[-1]] - time[up[0]])), highest


def main(arguments: list[str]) -> None:
    """Print a line per sine."""
    muscle, found, *recordings = arguments
    swing = json.loads(Path(found).read_text())["swinging"]["values"]
    print("measured and by the law, mm      |      mean     | peak to peak  |   frequency   |   half of it")
    for path in recordings:
        for stretch in stretches(read_bench(Path(path)), load_muscle(muscle), swing):
            print(stretch)


if __name__ == "__main__":
    main(sys.argv[1:])
