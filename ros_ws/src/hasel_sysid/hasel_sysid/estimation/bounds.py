"""Which fitted parameters a bound holds back."""

import numpy as np
from hasel_sim.model import Parameter

from hasel_sysid.estimation.bounded import bounded_change
from hasel_sysid.problem import Evaluation

_ON = 1e-4
"""Share of a range, or of a bound where there is none."""
_NEAR = 1e-2
"""Share of a bound: what is near zero is small, and may still be ten times too large."""


def at_bound(evaluation: Evaluation) -> tuple[str, ...]:
    """Names of the parameters that a fit ended on a bound of, or near one to which one more step would take them.

    A search that keeps inside its bounds comes to them by ever smaller steps, and ends somewhere on that way.
    """
    parameters, value, lower, upper = _ranges(evaluation)
    further, _ = bounded_change(evaluation.residual, evaluation.jacobian, lower - value, upper - value)
    ends = zip(parameters, value + further, strict=True)
    return tuple(p.name for p, end in ends if any(_held(p, bound, end) for bound in (p.lower, p.upper)))


def further_without_bounds(evaluation: Evaluation, name: str) -> float:
    """By how much one more step would move a parameter, were it not for its own bounds; the others keep theirs."""
    _, value, lower, upper = _ranges(evaluation)
    own = evaluation.names.index(name)
    lower[own], upper[own] = -np.inf, np.inf
    step, _ = bounded_change(evaluation.residual, evaluation.jacobian, lower - value, upper - value)
    return float(step[own])


def _ranges(evaluation: Evaluation) -> tuple[list[Parameter], np.ndarray, np.ndarray, np.ndarray]:
    """The parameters of an evaluation, their values and their bounds."""
    parameters = [evaluation.model.parameters[name] for name in evaluation.names]
    value, lower, upper = np.array([(p.value, p.lower, p.upper) for p in parameters]).reshape(-1, 3).T.copy()
    return parameters, value, lower, upper


def _held(p: Parameter, bound: float, end: float) -> bool:
    if not np.isfinite(bound):
        return False
    width = p.upper - p.lower
    on = _ON * (width if np.isfinite(width) else abs(bound) or 1.0)
    on_its_way = abs(p.value - bound) < _NEAR * abs(bound) and abs(end - bound) < on
    return bool(abs(p.value - bound) < on or on_its_way)
