"""A single Gauss-Newton step, as far as first order may be believed."""

from collections.abc import Sequence

import numpy as np
from hasel_sim.model import Model

from hasel_sysid.estimation.bounded import bounded_change

_MOST_CHANGE = 0.5
"""A single step changes no parameter but an effect's size by more than this share: beyond, derivatives say nothing."""


def bounded_step(
    model: Model, names: tuple[str, ...], residual: np.ndarray, jacobian: np.ndarray
) -> tuple[dict[str, float], float]:
    """Least squares of the linearised problem within the bounds: the values reached and the sum of squares there."""
    value = np.array([model.parameters[name].value for name in names])
    change, squares = bounded_change(residual, jacobian, *room(model, names))
    return dict(zip(names, value + change, strict=True)), squares


def room(model: Model, names: Sequence[str]) -> tuple[np.ndarray, np.ndarray]:
    """By how much a single step may change parameters [names], down and up: within their ranges, and by a share of
    their value what is of no effect, and of an effect what is no size: how fast it is, or where.
    """
    parameters = [model.parameters[name] for name in names]
    value = np.array([p.value for p in parameters])
    lower, upper = (np.array([getattr(p, side) for p in parameters]) for side in ("lower", "upper"))
    sizes = {f"{effect.id}.{p.name}" for effect in model.effects for p in effect.parameters if not p.scan}
    magnitude = np.array([np.inf if p.name in sizes else p.magnitude for p in parameters])
    reach = _MOST_CHANGE * magnitude
    return np.maximum(lower - value, -reach), np.minimum(upper - value, reach)
