"""Runs of a body that moves by a formula, for tests of fits: the optimum is known, and nothing is simulated."""

from collections.abc import Callable, Sequence

import numpy as np
from hasel_recording import Recording
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run, Simulation

from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Evaluation, Problem

Formula = Callable[[Model, np.ndarray], np.ndarray]
_STEP = 1e-6


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
