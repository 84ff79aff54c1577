"""Settled runs to fit, and how far a muscle's law is from them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from hasel_sim.muscle.muscle import Muscle

from hasel_sysid.bench_muscle.settled import SettledRun


@dataclass(frozen=True)
class BenchProblem:
    """Runs [k], of which only the frames `used` count. scales: by quantity, the largest answer of all that were read.

    A run with many frames counts no more than one with few: what is compared are its holds, each as one.
    """

    runs: tuple[SettledRun, ...]
    scales: dict[str, float]

    @cached_property
    def frames(self) -> int:
        """How many frames count."""
        return sum(int(run.used.sum()) for run in self.runs)

    @cached_property
    def holds(self) -> np.ndarray:
        """Number of the hold that each counting frame is in, from 0, [frames]."""
        found, last = [], 0
        for run in self.runs:
            _, number = np.unique(run.hold[run.used], return_inverse=True)
            found.append(number + last)
            last += int(number.max(initial=-1)) + 1
        return np.concatenate(found) if found else np.zeros(0, dtype=int)

    @cached_property
    def levels(self) -> np.ndarray:
        """Voltage [V] of the lift that each counting frame belongs to, [frames]; 0 for the rest before the first."""
        return self._gathered([run.level[run.used] for run in self.runs])

    @cached_property
    def driven(self) -> np.ndarray:
        """Whether there is a voltage, [frames]."""
        return self._gathered([run.voltage[run.used] != 0 for run in self.runs]).astype(bool)

    @cached_property
    def scale(self) -> np.ndarray:
        """Size of the answer's quantity [m or N], [frames]."""
        return self._gathered([np.full(run.used.sum(), self.scales[run.unit]) for run in self.runs])

    @cached_property
    def measured(self) -> np.ndarray:
        """The muscle's answers [m or N], [frames]."""
        return self._gathered([run.measured for run in self.runs])

    @cached_property
    def noise(self) -> np.ndarray:
        """Standard deviation of each counting frame, by its quantity's scale [1], [frames]."""
        return self._gathered([np.full(run.used.sum(), run.noise) for run in self.runs]) / self.scale

    @cached_property
    def zeros(self) -> np.ndarray:
        """What the frames of every run share as uncertainty of their zero, by the scale [1], [frames, runs]."""
        columns = np.zeros((self.frames, len(self.runs)))
        row = 0
        for number, run in enumerate(self.runs):
            count = int(run.used.sum())
            columns[row : row + count, number] = run.zero_error / self.scales[run.unit]
            row += count
        return columns

    def predicted(self, muscle: Muscle) -> np.ndarray:
        """The same by the law, [frames]."""
        return self._gathered([run.predicted(muscle) for run in self.runs])

    def residual(self, muscle: Muscle) -> np.ndarray:
        """Law less measurement by the quantity's scale [1], [frames]."""
        return (self.predicted(muscle) - self.measured) / self.scale

    @cached_property
    def weights(self) -> np.ndarray:
        """One over the number of frames of each frame's hold, [frames]: every hold counts as one."""
        return 1.0 / np.bincount(self.holds)[self.holds] if self.frames else np.zeros(0)

    def per_hold(self, residual: np.ndarray) -> np.ndarray:
        """Mean square of a residual in every hold, [holds]."""
        return np.bincount(self.holds, self.weights * residual**2)

    @cached_property
    def level_of_hold(self) -> np.ndarray:
        """Voltage [V] of every hold's lift, [holds]."""
        return np.bincount(self.holds, self.weights * self.levels)

    def error(self, muscle: Muscle) -> dict[str, float]:
        """Mean |law - measurement| of the holds by quantity, in metres and newtons."""
        away = np.abs(self.predicted(muscle) - self.measured)
        found = {}
        for unit in self.scales:
            here = self._gathered([np.full(run.used.sum(), run.unit == unit) for run in self.runs]).astype(
                bool
            )
            if here.any():
                found[unit] = float(np.average(away[here], weights=self.weights[here]))
        return found

    def as_if(self, muscle: Muscle) -> "BenchProblem":
        """The problem in a world in which this muscle is right."""
        runs = []
        for run in self.runs:
            quantity = "contraction" if run.held == "load" else "load"
            answer = getattr(run, quantity).copy()
            answer[run.used] = run.predicted(muscle)
            runs.append(replace(run, **{quantity: answer}))
        return BenchProblem(tuple(runs), self.scales)

    def only_levels(self, levels: Sequence[float] | np.ndarray, keep: bool = True) -> "BenchProblem":
        """The problem with the frames of some levels [V] (keep) or without them."""
        chosen = [run.only(np.isin(run.level, levels) == keep) for run in self.runs]
        return BenchProblem(tuple(run for run in chosen if run.used.any()), self.scales)

    def _gathered(self, parts: list[np.ndarray]) -> np.ndarray:
        return np.concatenate(parts) if parts else np.zeros(0)


def bench_problem(runs: Sequence[SettledRun], scales: dict[str, float] | None = None) -> BenchProblem:
    """A problem of these runs; scales: of another problem, where errors are to be compared."""
    if scales is None:
        scales = {}
        for run in runs:
            largest = float(np.max(np.abs(run.measured), initial=0.0))
            scales[run.unit] = max(scales.get(run.unit, 0.0), largest)
    return BenchProblem(tuple(runs), {unit: size or 1.0 for unit, size in scales.items()})
