"""What a change of values would do, by the derivatives that are known: at once, before anything is simulated."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from hasel_sysid.problem import Evaluation

from hasel_workbench.evaluate import evaluation_of
from hasel_workbench.step import Step

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
    evaluation, own = evaluation_of(step, number)
    simulation = evaluation.simulations[own]
    sin_theta = simulation.sin_theta + simulation.slopes @ _vector(evaluation, change)
    unseen = None if step.unseen is None else _error(step.unseen, change)
    return Prediction(sin_theta, _error(step.seen, change), unseen)


def beyond_first_order(foretold: np.ndarray, true: np.ndarray, shown: np.ndarray) -> bool:
    """Whether a change is so large that derivatives mislead: what they miss of a run [n] is a fifth of the change."""
    missed, change = (float(np.sqrt(np.mean(each**2))) for each in (true - foretold, true - shown))
    return missed > _MISLEADS * change


def _vector(evaluation: Evaluation, change: Mapping[str, float]) -> np.ndarray:
    return np.array([change.get(name, 0.0) for name in evaluation.names])


def _error(evaluation: Evaluation, change: Mapping[str, float]) -> float:
    return float(np.abs(evaluation.residual - evaluation.jacobian @ _vector(evaluation, change)).mean())
