# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Settled strokes of a muscle as a problem: what its law leaves of every voltage's lifts, by formula."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import cast

import numpy as np
from hasel_recording import Recording
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.muscle.muscle import Muscle
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run, Simulation
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment
from hasel_sysid.noise import NoiseModel
from hasel_sysid.problem import Evaluation, Problem

from hasel_muscle.settled import SettledRun

_STEP = 1e-4
"""Of a parameter's range, for derivatives by differences."""


@dataclass(frozen=True, eq=False)
class Lifts(Experiment):
    """The frames of one recording that belong to one voltage, as a run; its series are by the quantity's scale [1].

    of: the recording; frames [used]: which of its counting frames.
    """

    of: SettledRun
    frames: np.ndarray


class BenchProblem(Problem):
    """Recordings [k], of which only the frames `used` count, by voltage: those of one, and the rests after them, are a
    run. scales: by quantity, the largest answer of all that were read.

    The law is a formula: a muscle stands where a body's model stands, and nothing is finer or cruder than it. The zero
    of every recording is known but for its error.
    """

    free_offset = False
    experiments: tuple[Lifts, ...]

    def __init__(self, settled: Sequence[SettledRun], scales: dict[str, float] | None = None) -> None:
        """scales: of another problem, to compare errors. Raises SysidError where nothing is left that counts."""
        self.runs, self.scales = tuple(settled), dict(scales or {})
        for run in () if scales else self.runs:
            self.scales[run.unit] = np.max(np.abs(run.measured), initial=self.scales.get(run.unit, 0.0))
        self.scales = {unit: float(size) or 1.0 for unit, size in self.scales.items()}
        super().__init__([lifts for run in self.runs for lifts in self._by_voltage(run)], SerialExecutor())

    def _by_voltage(self, run: SettledRun) -> list[Lifts]:
        level, time = run.level[run.used], run.time[run.used]
        found = []
        for volts in np.unique(level):
            here = level == volts
            name = f"{volts:g} V" if volts else "before any lift"
            name = name if len(self.runs) == 1 else f"{run.name}, {name}"
            series = run.measured[here] / self.scales[run.unit]
            found.append(Lifts(Recording(name, time[here], series), Run(name, time[here]), run, here))
        return found

    @cached_property
    def measured_noise(self) -> NoiseModel:
        """That of a settled frame. Raises SysidError where too few frames tell it."""
        shares = np.array([run.noise / self.scales[run.unit] for run in self.runs])
        for run, share in zip(self.runs, shares, strict=True):
            if not share > 0:
                raise SysidError(
                    f"{run.name} does not tell the noise of a settled frame ({run.noise_source}); expected a rest of a "
                    "second and more before the first lift"
                )
        frames = [run.used.sum() for run in self.runs]
        white = float(np.average(shares**2, weights=frames))
        return NoiseModel(white, 0.0, 0.5, self.runs[0].noise_source)

    @cached_property
    def repeatability(self) -> float | None:
        """Standard deviation of lifts alike, by the answer's scale; None where no lift was repeated."""
        groups: dict[tuple[str, float, float], list[float]] = {}
        for run in self.runs:
            level, voltage, hold = (each[run.used] for each in (run.level, run.voltage, run.hold))
            for number in np.unique(hold[voltage != 0]):
                here = hold == number
                key = (run.held, float(level[here][0]), float(f"{np.median(run.kept[here]):.2g}"))
                groups.setdefault(key, []).append(
                    float(np.median(run.measured[here])) / self.scales[run.unit]
                )
        repeated = [values for values in groups.values() if len(values) > 1]
        if not repeated:
            return None
        squares = sum(len(values) * np.var(values) for values in repeated)
        return float(np.sqrt(squares / sum(len(values) - 1 for values in repeated)))

    @property
    def discrepancy(self) -> float:
        """What lifts alike differ by, and no less than the noise of a frame: what no frame shows does not matter."""
        return max(self.repeatability or 0.0, self.measured_noise.standard_deviation)

    def low_fidelity(self, model: Model) -> Model:
        """A formula costs little: itself."""
        return model

    @property
    def shared_errors(self) -> Sequence[np.ndarray]:
        """What the zero of every recording is uncertain by, by the quantity's scale."""
        errors = [run.zero_error / self.scales[run.unit] for run in self.runs]
        return [
            np.concatenate([np.full(e.frames.sum(), error * (e.of is run)) for e in self.experiments])
            for run, error in zip(self.runs, errors, strict=True)
            if error
        ]

    def refinements(self, model: Model) -> dict[str, Model]:
        """A formula has no numerics that could be finer."""
        return {}

    def work(self, model: Model, names: Sequence[str] = ()) -> float:
        """Evaluations of the formula, two for each derivative."""
        return 1.0 + 2.0 * len(names)

    def evaluate_each(
        self, models: Sequence[Model], names: Sequence[Sequence[str]]
    ) -> list[Evaluation | SimulationError]:
        """As of a problem that simulates; the models are muscles."""
        self.workload.check()
        self.evaluations += len(models)
        found: list[Evaluation | SimulationError] = []
        for model, by in zip(models, names, strict=True):
            try:
                found.append(self._collect(model, tuple(by), self._simulated(as_muscle(model), tuple(by))))
            except SimulationError as error:
                found.append(error)
            self.workload.did(self.work(model, by))
        return found

    def _simulated(self, muscle: Muscle, names: tuple[str, ...]) -> list[Simulation]:
        series = self._series(muscle)
        slopes = [np.zeros((len(one), len(names))) for one in series]
        for column, name in enumerate(names):
            p = muscle.parameters[name]
            step = _STEP * (p.upper - p.lower)
            ends = np.clip([p.value - step, p.value + step], p.lower, p.upper)
            less, more = (self._series(muscle.with_values({name: end})) for end in ends)
            for run, one in enumerate(slopes):
                one[:, column] = (more[run] - less[run]) / np.ptp(ends)
        return [
            Simulation(lifts.run, one, names, slope, np.zeros((len(one), 0)), np.zeros((len(one), 0)))
            for lifts, one, slope in zip(self.experiments, series, slopes, strict=True)
        ]

    def _series(self, muscle: Muscle) -> list[np.ndarray]:
        """The law's answer by the quantity's scale in the frames of every run."""
        answers = {id(run): run.predicted(muscle) / self.scales[run.unit] for run in self.runs}
        found = [answers[id(one.of)][one.frames] for one in self.experiments]
        if not all(np.isfinite(one).all() for one in found):
            raise SimulationError(f"the law of muscle '{muscle.name}' has no answer there")
        return found

    # what is shown

    @cached_property
    def voltages(self) -> np.ndarray:
        """Of the lifts [V], ascending."""
        levels = np.unique(self.levels[self.driven])
        return levels[levels > 0]

    @cached_property
    def holds(self) -> np.ndarray:
        """Number of the hold that each counting frame is in, from 0, [frames]."""
        runs = np.repeat(np.arange(len(self.runs)), [run.used.sum() for run in self.runs])
        holds = np.concatenate([run.hold[run.used] for run in self.runs])
        return np.unique(np.stack([runs, holds]), axis=1, return_inverse=True)[1].ravel()

    @cached_property
    def levels(self) -> np.ndarray:
        """Voltage [V] of the lift that each counting frame belongs to, [frames]; 0 for the rest before the first."""
        return np.concatenate([run.level[run.used] for run in self.runs])

    @cached_property
    def units(self) -> np.ndarray:
        """Of the answers, [frames]."""
        return np.concatenate([np.full(run.used.sum(), run.unit) for run in self.runs])

    @cached_property
    def driven(self) -> np.ndarray:
        """Whether there is a voltage, [frames]."""
        return np.concatenate([run.voltage[run.used] != 0 for run in self.runs])

    @cached_property
    def measured(self) -> np.ndarray:
        """The muscle's answers [m or N], [frames]."""
        return np.concatenate([run.measured for run in self.runs])

    def predicted(self, muscle: Muscle) -> np.ndarray:
        """The same by the law, [frames]."""
        return np.concatenate([run.predicted(muscle) for run in self.runs])

    @cached_property
    def weights(self) -> np.ndarray:
        """One over the number of frames of each frame's hold, [frames]: every hold counts as one."""
        return 1.0 / np.bincount(self.holds)[self.holds]

    def error(self, muscle: Muscle) -> dict[str, float]:
        """Mean |law - measurement| of the holds by quantity, in metres and newtons."""
        away = np.abs(self.predicted(muscle) - self.measured)
        frames = {unit: self.units == unit for unit in self.scales}
        return {
            unit: float(np.average(away[here], weights=self.weights[here]))
            for unit, here in frames.items()
            if here.any()
        }

    def only_levels(self, levels: Sequence[float] | np.ndarray, keep: bool = True) -> "BenchProblem":
        """The problem with the frames of some levels [V] (keep) or without them; the history of others stays.

        Raises SysidError where none is left.
        """
        chosen = [replace(run, used=run.used & (np.isin(run.level, levels) == keep)) for run in self.runs]
        return BenchProblem([run for run in chosen if run.used.any()], self.scales)


def as_model(muscle: Muscle) -> Model:
    """A muscle where the search asks for a model: it asks for effects and parameters only, which a muscle has too."""
    return cast(Model, muscle)


def as_muscle(model: Model) -> Muscle:
    """And back."""
    return cast(Muscle, model)
