# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One model of a session: what it says of every run, how it came about, and what other values would change at once."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from hasel_sim.model import Model
from hasel_sim.run import Simulation
from hasel_sysid.comparison import Comparison, comparison_of
from hasel_sysid.estimation import FittedModel
from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Evaluation


@dataclass(frozen=True)
class Step:
    """label: what was done last; model; seen, unseen: it against the fitted and the unseen runs (None without such),
    with derivatives by all its free parameters; fit: of these runs, None where the values were set by hand.

    did: the lines of Python that lead here from the step before; file: its model file, empty until it is kept.
    """

    label: str
    model: Model
    experiments: tuple[Experiment, ...]
    others: tuple[Experiment, ...]
    seen: Evaluation
    unseen: Evaluation | None = None
    fit: FittedModel | None = None
    did: tuple[str, ...] = ()
    file: str = ""

    @property
    def error(self) -> float:
        """Mean |Δ sin θ| on the fitted runs."""
        return self.seen.mean_absolute_error

    @property
    def error_unseen(self) -> float | None:
        """Mean |Δ sin θ| on the unseen runs; None without any."""
        return None if self.unseen is None else self.unseen.mean_absolute_error

    @property
    def simulations(self) -> tuple[Simulation, ...]:
        """Of all runs, the unseen ones last."""
        return (*self.seen.simulations, *(() if self.unseen is None else self.unseen.simulations))

    @cached_property
    def comparison(self) -> Comparison:
        """Where it fails, run by run and in all runs."""
        return comparison_of(self.model, self.experiments, self.simulations, self.others, self.label)

    @property
    def effects(self) -> tuple[str, ...]:
        """Ids of the model's effects."""
        return tuple(effect.id for effect in self.model.effects)

    def __str__(self) -> str:
        unseen = "" if self.error_unseen is None else f", {self.error_unseen:.5f} on unseen runs"
        return f"{self.label}: mean |Δ sin θ| {self.error:.5f} on fitted runs{unseen}"


_MISLEADS = 0.2


@dataclass(frozen=True)
class Prediction:
    """sin_theta [n]: of one run at its frames; error, error_unseen: mean |Δ sin θ| of all runs (None without such)."""

    sin_theta: np.ndarray
    error: float
    error_unseen: float | None


def predicted(step: Step, number: int, values: Mapping[str, float]) -> Prediction:
    """Simulated series plus derivative times change; good for changes that are small beside what they change.

    number: of the run that is looked at, among all runs; values: of some parameters, the others stay as they are.
    Raises ModelError for a parameter that the model has not got.
    """
    change = {name: value - step.model.parameter(name).value for name, value in values.items()}
    evaluation = step.seen if step.unseen is None or number < len(step.experiments) else step.unseen
    simulation, by = step.simulations[number], [change.get(name, 0.0) for name in evaluation.names]
    sin_theta = simulation.sin_theta + simulation.slopes @ by
    unseen = None if step.unseen is None else _error(step.unseen, change)
    return Prediction(sin_theta, _error(step.seen, change), unseen)


def beyond_first_order(foretold: np.ndarray, true: np.ndarray, shown: np.ndarray) -> bool:
    """Whether a change is so large that derivatives mislead: what they miss of a run [n] is a fifth of the change."""
    missed, change = (float(np.sqrt(np.mean(each**2))) for each in (true - foretold, true - shown))
    return missed > _MISLEADS * change


def _error(evaluation: Evaluation, change: Mapping[str, float]) -> float:
    step = [change.get(name, 0.0) for name in evaluation.names]
    return float(np.abs(evaluation.residual - evaluation.jacobian @ step).mean())
