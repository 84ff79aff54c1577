"""Weights of a state: the derivative of what is optimised by every number of the state."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.mechanics import compiled
from hasel_sim.mechanics.solid import Solid
from hasel_sim.mechanics.state import State


@dataclass
class StateWeights:
    """The same arrays as a `State`; branch and green are None without internal branches."""

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    branch: np.ndarray | None = None
    green: np.ndarray | None = None


def no_weights(state: State) -> StateWeights:
    """Zero weights for a state."""
    nothing = np.zeros_like(state.position)
    weights = StateWeights(nothing, nothing.copy(), nothing.copy())
    if state.branch is not None:
        weights.branch, weights.green = np.zeros_like(state.branch), np.zeros_like(state.green)
    return weights


def green_pulled_back(solid: Solid, position: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """What weights of C : E [elements, points, 3] mean for the positions, [nodes, 2]."""
    F = solid.gradient(position)
    shear, lame = solid.shear[:, None], solid.linear_lame[:, None]
    trace = lame * (weights[..., 0] + weights[..., 1])
    xx, yy = trace + 2 * shear * weights[..., 0], trace + 2 * shear * weights[..., 1]
    return _scattered(solid, times_symmetric(F, xx, yy, shear * weights[..., 2]))


def history_pulled_back(solid: Solid, F: np.ndarray, multiplier: np.ndarray) -> np.ndarray:
    """What a multiplier of the residual [nodes, 2] means for the branches' history, [elements, points, 3]."""
    a, b, c, d = np.moveaxis(F, -1, 0)
    m0, m1, m2, m3 = np.moveaxis(solid.gradient(multiplier), -1, 0)
    change = np.stack([a * m0 + c * m2, b * m1 + d * m3, a * m1 + c * m3 + b * m0 + d * m2], axis=-1)
    return solid.areas[..., None] * change


def times_symmetric(F: np.ndarray, xx: np.ndarray, yy: np.ndarray, xy: np.ndarray) -> np.ndarray:
    """F S for a symmetric S, [elements, points, 4]."""
    a, b, c, d = np.moveaxis(F, -1, 0)
    return np.stack([a * xx + b * xy, a * xy + b * yy, c * xx + d * xy, c * xy + d * yy], axis=-1)


def _scattered(solid: Solid, weights: np.ndarray) -> np.ndarray:
    out = np.zeros((int(solid.elements.max()) + 1, 2))
    ones = np.ones_like(solid.areas)
    compiled.scatter_stress(weights, solid.elements, solid.gradients, ones, out)
    return out
