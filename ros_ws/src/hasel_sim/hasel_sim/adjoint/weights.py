"""Weights of a state: the derivative of what is optimised by every number of the state."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.mechanics.solid import Solid
from hasel_sim.mechanics.state import State
from hasel_sim.mechanics.strain import times_symmetric


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
    """What weights of C : E [elements, points, 3, 1] mean for the positions, [nodes, 2, 1]."""
    F = solid.gradient(position)
    shear, lame = solid.shear[:, None], solid.linear_lame[:, None]
    wxx, wyy, wxy = np.moveaxis(weights, -2, 0)
    trace = lame * (wxx + wyy)
    P = times_symmetric(F, trace + 2 * shear * wxx, trace + 2 * shear * wyy, shear * wxy)
    return _scattered(solid, P, len(position))


def history_pulled_back(solid: Solid, F: np.ndarray, multiplier: np.ndarray) -> np.ndarray:
    """What a multiplier of the residual [nodes, 2, 1] means for the branches' history, [elements, points, 3, 1]."""
    a, b, c, d = np.moveaxis(F, -2, 0)
    m0, m1, m2, m3 = np.moveaxis(solid.gradient(multiplier), -2, 0)
    change = np.stack([a * m0 + c * m2, b * m1 + d * m3, a * m1 + c * m3 + b * m0 + d * m2], axis=-2)
    return (solid.areas[..., None] * solid.stretch)[:, :, None] * change


def _scattered(solid: Solid, weights: np.ndarray, nodes: int) -> np.ndarray:
    """What weights of F at the Gauss points mean for the nodes: the forces of a stress, per area."""
    out = np.zeros((nodes, 2, 1))
    per_area = weights / (solid.areas[..., None] * solid.stretch)[:, :, None]
    solid.add_force(per_area, out)
    return out
