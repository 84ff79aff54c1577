# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Runs of a swimmer in a world in which every parameter moves the angle by a known series, and of two such worlds."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from hasel_recording import Recording
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import Effect
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, load_model
from hasel_sim.model.model_parameters import constants
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run, Simulation
from hasel_sim.simulate import simulate

from hasel_sysid.expected_work import TimeLimit
from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Evaluation, Problem

VOLTAGES, FREQUENCIES = (3500.0, 4500.0, 5500.0), (0.5, 2.0)
NOISE = 0.0024
_FRAME_RATE, _DURATION = 120.0, 2.0
_TONES = 6
_EFFECT, _DRIVEN = 0.02, 0.1
_LONG = 0.4


class MadeUpWorld:
    """sin theta = sum over the parameters of (value - null) / (typical - null) times a smooth series of its own.

    A value that stands for a time or a place turns its effect's series into another one, in proportion to its logarithm
    (or to the value itself where it may be zero or negative). alike: pairs of effects whose series differ by a tenth;
    shared: how many series all others are mixed of, but for a tenth of their own (0: none); constants: of the model
    file, each of which moves the angle as these effects of typical size do together if it is a fifth larger.
    """

    def __init__(
        self,
        seed: int,
        alike: Mapping[str, str] | None = None,
        shared: int = 0,
        constants: Mapping[str, Sequence[str]] | None = None,
    ) -> None:
        self._seed, self._alike, self._shared = seed, dict(alike or {}), shared
        self._constants = dict(constants or {})
        self._known: dict[str, list[np.ndarray]] = {}
        self.model = load_model("swimmer").with_levels(list(VOLTAGES))

    @cached_property
    def runs(self) -> list[Run]:
        """One of each voltage at each frequency."""
        time = np.arange(0.0, _DURATION, 1 / _FRAME_RATE)
        return [
            Run(f"{voltage:.0f}V_{frequency:.1f}Hz", time, box_drive(voltage, frequency))
            for voltage in VOLTAGES
            for frequency in FREQUENCIES
        ]

    def with_typical(self, *effects: str) -> Model:
        """The model with effects of their typical sizes, and amplitudes that rise with the voltage."""
        rising = {f"amplitude_{v:.0f}": 0.03 + 0.02 * number for number, v in enumerate(VOLTAGES)}
        model = self.model.with_effects(*effects) if effects else self.model
        typical = {f"{e.id}.{p.name}": p.typical for e in model.effects for p in e.parameters}
        return model.with_values({**rising, **typical})

    def sin_theta(self, model: Model) -> list[np.ndarray]:
        """The angle of every run."""
        return self.sin_theta_at(model.effects, model.values)

    def sin_theta_at(self, effects: Sequence[Effect], values: Mapping[str, float]) -> list[np.ndarray]:
        """The same with values that need not lie within their ranges."""
        total = [np.zeros(len(run.time)) for run in self.runs]
        for name, value in values.items():
            if "." not in name and name.startswith("amplitude_"):
                self._add(total, name, (value / 0.05) * _DRIVEN, float(name.partition("_")[2]))
            elif name == "slope":
                self._add(total, name, 0.02 * np.log(max(value, 1e-6)))
            for effect in self._constants.get(name, ()):
                self._add(
                    total, effect, _EFFECT * (value / constants(self.model.description)[name] - 1) / 0.2
                )
        for effect in effects:
            size, turn = 0.0, 0.0
            for p in effect.parameters:
                value = values[f"{effect.id}.{p.name}"]
                if not p.scan:
                    size += (value - p.null) / abs(p.typical - p.null)
                elif min(p.scan) > 0:
                    turn += _LONG * np.log(max(value, 1e-9) / p.scan[len(p.scan) // 2])
                else:
                    turn += _LONG * (value - p.scan[len(p.scan) // 2]) / np.ptp(p.scan)
            self._add(total, effect.id, _EFFECT * size)
            self._add(total, f"{effect.id} turned", _EFFECT * size * turn)
        return total

    def measured(
        self,
        model: Model,
        noise: float = NOISE,
        stranger: float = 0.0,
        most_evaluations: float = math.inf,
        strange_at: float | None = None,
    ) -> "MadeUpProblem":
        """Runs as they would be measured if the model were the truth, but for a stranger of so much rms.

        most_evaluations: after which the time of a search is over; strange_at: the only voltage [V] with the stranger.
        """
        series = self._with_noise(self.sin_theta(model), noise)
        self._add(series, "stranger", stranger, strange_at)
        return MadeUpProblem(self, series, most_evaluations)

    def measured_of_each(self, truths: Mapping[float, Model]) -> "MadeUpProblem":
        """Runs as they would be measured if at every voltage another model were the truth."""
        each = {voltage: self.sin_theta(model) for voltage, model in truths.items()}
        angles = [each[float(run.name.partition("V")[0])][number] for number, run in enumerate(self.runs)]
        return MadeUpProblem(self, self._with_noise(angles, NOISE))

    def _with_noise(self, angles: Sequence[np.ndarray], noise: float) -> list[np.ndarray]:
        generator = np.random.default_rng(self._seed)
        return [angle + noise * generator.standard_normal(len(angle)) for angle in angles]

    def _add(self, total: list[np.ndarray], name: str, size: float, voltage: float | None = None) -> None:
        for run, series, own in zip(self.runs, total, self._series(name), strict=True):
            if voltage is None or run.name.startswith(f"{voltage:.0f}V"):
                series += size * own

    def _series(self, name: str) -> list[np.ndarray]:
        if name not in self._known:
            twin = self._alike.get(name)
            generator = np.random.default_rng([self._seed, *name.encode()])
            own = [_smooth(run.time, generator) for run in self.runs]
            if self._shared and not name.startswith("shared "):
                mixed = generator.standard_normal(self._shared) / np.sqrt(self._shared)
                basis = [self._series(f"shared {number}") for number in range(self._shared)]
                own = [
                    0.1 * s + sum(w * part[run] for w, part in zip(mixed, basis, strict=True))
                    for run, s in enumerate(own)
                ]
            if twin is not None:
                own = [s + 0.1 * other for s, other in zip(self._series(twin), own, strict=True)]
            self._known[name] = own
        return self._known[name]


def _drive_at_frames(run: Run) -> np.ndarray | None:
    return None if run.schedule is None else run.schedule.at(run.time)


class MadeUpProblem(Problem):
    """Measured runs of a made-up world; models are evaluated in it, with central differences for derivatives."""

    def __init__(
        self, world: MadeUpWorld, measured: Sequence[np.ndarray], most_evaluations: float = math.inf
    ) -> None:
        experiments = [
            Experiment(Recording(run.name, run.time, series, drive_signal=_drive_at_frames(run)), run)
            for run, series in zip(world.runs, measured, strict=True)
        ]
        super().__init__(experiments, SerialExecutor())
        self.world = world
        self.time_limit = TimeLimit(most_evaluations, clock=lambda: self.evaluations)

    def evaluate_each(
        self, models: Sequence[Model], names: Sequence[Sequence[str]]
    ) -> list[Evaluation | SimulationError]:
        """As of a problem that simulates."""
        self.evaluations += len(models)
        return [self._made_up(model, tuple(by)) for model, by in zip(models, names, strict=True)]

    def _made_up(self, model: Model, names: tuple[str, ...]) -> Evaluation:
        return self._collect(model, names, self.simulations(self.world, model, names))

    def simulations(self, world: MadeUpWorld, model: Model, names: tuple[str, ...]) -> list[Simulation]:
        """Of every experiment, by a world."""
        series = self._of_experiments(world.sin_theta(model))
        slopes = [np.zeros((len(own), len(names))) for own in series]
        for index, name in enumerate(names):
            step = 1e-6 * max(abs(model.values[name]), 1e-6)
            more, less = (
                self._of_experiments(
                    world.sin_theta_at(model.effects, {**model.values, name: model.values[name] + change})
                )
                for change in (step, -step)
            )
            for of_run, above, below in zip(slopes, more, less, strict=True):
                of_run[:, index] = (above - below) / (2 * step)
        return [
            Simulation(one.run, own, names, of_run, np.zeros((len(own), 3, 2)), np.zeros((len(own), 2)))
            for one, own, of_run in zip(self.experiments, series, slopes, strict=True)
        ]

    def _of_experiments(self, of_runs: list[np.ndarray]) -> list[np.ndarray]:
        """Of what is known of every run of the world, what belongs to the experiments, or to their first frames."""
        number = {run.name: number for number, run in enumerate(self.world.runs)}
        return [of_runs[number[one.run.name]][: len(one.run.time)] for one in self.experiments]


def box_drive(voltage: float, frequency: float) -> DriveSchedule:
    """Upper and lower muscle in turn, for as long as any made-up run takes."""
    switches = np.arange(0.0, _DURATION, 0.5 / frequency)
    side = np.arange(len(switches)) % 2
    return DriveSchedule(switches, voltage * np.column_stack([side == 0, side == 1]).astype(float))


def _smooth(time: np.ndarray, generator: np.random.Generator) -> np.ndarray:
    """A sum of a few tones of 0.5 to 8 Hz with an rms of 1."""
    frequency, phase = generator.uniform(0.5, 8.0, _TONES), generator.uniform(0, 2 * np.pi, _TONES)
    series = np.sin(2 * np.pi * np.outer(time, frequency) + phase) @ generator.standard_normal(_TONES)
    return series / max(float(np.std(series)), 1e-12)


@dataclass(frozen=True)
class TwoMeasured(Experiment):
    """other: of the second angle."""

    other: Recording

    @property
    def outputs(self) -> np.ndarray:
        """Both angles, [n, 2]."""
        return np.column_stack([self.sin_theta, self.other.sin_theta[: len(self.run.time)]])


@dataclass(frozen=True)
class TwoSimulated(Simulation):
    """other: of the second angle."""

    other: Simulation = field(kw_only=True)

    @property
    def outputs(self) -> np.ndarray:
        """Both angles, [n, 2]."""
        return np.column_stack([self.sin_theta, self.other.sin_theta])

    @property
    def output_slopes(self) -> np.ndarray:
        """Their derivatives, [n, 2, parameters]."""
        return np.stack([self.slopes, self.other.slopes], axis=1)


class TwoOutputs(MadeUpProblem):
    """Measured runs of two worlds in which a model's parameters move one angle each."""

    def __init__(self, first: MadeUpWorld, second: MadeUpWorld, truth: Model, noise: float = NOISE) -> None:
        """truth: as of `MadeUpWorld.measured`."""
        one, other = first.measured(truth, noise), second.measured(truth, noise)
        super().__init__(first, [e.sin_theta for e in one.experiments])
        self.second = second
        self.experiments = tuple(
            TwoMeasured(e.recording, e.run, o.recording)
            for e, o in zip(one.experiments, other.experiments, strict=True)
        )

    def _made_up(self, model: Model, names: tuple[str, ...]) -> Evaluation:
        both = (self.simulations(world, model, names) for world in (self.world, self.second))
        return self._collect(
            model,
            names,
            [TwoSimulated(**{**vars(one), "other": other}) for one, other in zip(*both, strict=True)],
        )


def simulated_runs(truth: Model, drives: Iterable[tuple[float, float]], time: np.ndarray) -> Problem:
    """One run per voltage [V] and frequency [Hz] of a box drive, at these times [s] [n]."""
    experiments = []
    for voltage, frequency in drives:
        schedule = box_drive(voltage, frequency)
        run = Run(f"{voltage:.0f} V, {frequency} Hz", time, schedule)
        angle = simulate(truth, run).sin_theta
        experiments.append(Experiment(Recording(run.name, time, angle, drive_signal=schedule.at(time)), run))
    return Problem(experiments, SerialExecutor())
