# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Made-up effects, and models beside runs: what is missed in every frame is known, and nothing is simulated."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cache

import numpy as np
from hasel_recording import Recording
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.effects.base import Effect, EffectParameter, ObservationEffect
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model, Parameter, load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run, Simulation

from hasel_sysid.comparison import Comparison, RunComparison
from hasel_sysid.estimation import FittedModel
from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.residual_analysis.analysis import where_it_fails
from hasel_sysid.residual_analysis.run_series import run_series

_STEP = 1e-6


def made_up_size(largest: float = 10.0) -> EffectParameter:
    """A size that is noticed at 1."""
    return EffectParameter("size", "x", "1", 0.0, 0.0, largest, 1.0)


def made_up_effect(name: str, *parameters: EffectParameter) -> Effect:
    """An effect of this name; default of its parameters: one size."""
    return type(name, (ObservationEffect,), {"id": name, "parameters": parameters or (made_up_size(),)})()


def with_made_up(model: Model, *effects: Effect) -> Model:
    """The model with these effects at their nulls, as `Model.with_effects` has it of those in the catalogue."""
    sizes = {f"{effect.id}.{p.name}": p for effect in effects for p in effect.parameters}
    parameters = {name: Parameter(name, p.null, p.unit, p.lower, p.upper) for name, p in sizes.items()}
    return replace(model, effects=(*model.effects, *effects), parameters={**model.parameters, **parameters})


@cache
def _swimmer() -> Model:
    """What nobody asks about where no model is given."""
    return load_model("swimmer")


def made_up_evaluation(
    residual: np.ndarray,
    time: np.ndarray,
    schedules: Sequence[DriveSchedule | None] | None = None,
    simulated: np.ndarray | None = None,
    jacobian: np.ndarray | None = None,
    names: tuple[str, ...] = (),
    model: Model | None = None,
) -> Evaluation:
    """Runs with the same frames.

    residual [runs, frames]; time [s] [frames]; schedules: of every run (default: passive); simulated: sin theta
    [frames], the same in every run (default: 0); jacobian [frames, parameters], likewise.
    """
    count = len(residual)
    runs = [Run(f"run {n}", time, schedule) for n, schedule in enumerate(schedules or [None] * count)]
    return evaluation_of_runs(
        runs,
        residual.ravel(),
        None if simulated is None else np.tile(simulated, count),
        None if jacobian is None else np.tile(jacobian, (count, 1)),
        names,
        model,
    )


def evaluation_of_runs(
    runs: Sequence[Run],
    residual: np.ndarray,
    simulated: np.ndarray | None = None,
    jacobian: np.ndarray | None = None,
    names: tuple[str, ...] = (),
    model: Model | None = None,
) -> Evaluation:
    """Runs with frames of their own, one after the other.

    residual, simulated (default: 0) [frames of all runs]; jacobian [frames of all runs, parameters].
    """
    lengths = [len(run.time) for run in runs]
    series = np.zeros(len(residual)) if simulated is None else simulated
    slopes = np.zeros((len(residual), len(names))) if jacobian is None else jacobian
    of_runs = np.repeat(np.arange(len(runs)), lengths)
    simulations = tuple(
        Simulation(
            run,
            series[of_runs == n],
            names,
            slopes[of_runs == n],
            np.zeros((length, 0)),
            np.zeros((length, 0)),
        )
        for n, (run, length) in enumerate(zip(runs, lengths, strict=True))
    )
    frames = tuple(np.ones((length, 1), dtype=bool) for length in lengths)
    return Evaluation(
        _swimmer() if model is None else model,
        names,
        simulations,
        residual,
        slopes,
        of_runs,
        np.zeros(len(runs)),
        frames,
    )


def made_up_fit(model: Model, error: float, at_bound: tuple[str, ...] = ()) -> FittedModel:
    """A fit with this mean |Δ sin θ|, of the model's free parameters."""
    evaluation = made_up_evaluation(
        error * np.array([[1.0, -1.0]]), np.array([0.0, 0.01]), names=model.free, model=model
    )
    return FittedModel(model, evaluation, at_bound, (), 1, "least_squares")


def made_up_comparison(model: Model, label: str, error: float, unseen: float) -> Comparison:
    """A comparison with these means of |Δ sin θ|: one fitted run of two frames, and one unseen."""
    time = np.array([0.0, 0.01])
    series = [
        run_series(name, time, size * np.array([1.0, -1.0]), np.zeros(2))
        for name, size in (("fitted", error), ("unseen", unseen))
    ]
    where = where_it_fails(series)
    runs = tuple(
        RunComparison(one, one.name == "unseen", found) for one, found in zip(series, where.runs, strict=True)
    )
    return Comparison(label, model, runs, where)


Formula = Callable[[Model, np.ndarray], np.ndarray]


class FormulaProblem(Problem):
    """One run; formula: sin theta [frames] of a model at times [s] [frames]. Derivatives are central differences."""

    def __init__(self, formula: Formula, time: np.ndarray, measured: np.ndarray) -> None:
        """time [s], measured: sin theta, [frames]."""
        super().__init__([Experiment(Recording("run", time, measured), Run("run", time))], SerialExecutor())
        self._formula = formula

    def evaluate_each(
        self, models: Sequence[Model], names: Sequence[Sequence[str]]
    ) -> list[Evaluation | SimulationError]:
        """As of a problem that simulates."""
        self.evaluations += len(models)
        return [
            self._collect(
                model, tuple(by), [self._simulated(model, tuple(by), e.run) for e in self.experiments]
            )
            for model, by in zip(models, names, strict=True)
        ]

    def _simulated(self, model: Model, names: tuple[str, ...], run: Run) -> Simulation:
        slopes = np.zeros((len(run.time), len(names)))
        for column, name in zip(slopes.T, names, strict=True):
            p = model.parameters[name]
            step = _STEP * max(p.magnitude, _STEP)
            ends = np.clip([p.value - step, p.value + step], p.lower, p.upper)
            less, more = (self._formula(model.with_values({name: end}), run.time) for end in ends)
            column[:] = (more - less) / np.ptp(ends)
        nothing = np.zeros((len(run.time), 0))
        return Simulation(run, self._formula(model, run.time), names, slopes, nothing, nothing)
