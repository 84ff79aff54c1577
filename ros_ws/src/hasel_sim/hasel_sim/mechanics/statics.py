"""Static equilibrium by Newton's method with load steps; a free body is anchored by its own inertia."""

import numpy as np

from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.banded import BandMatrix
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.system import Linearisation, System

_ANCHOR = 1e-3
"""Weight of the mass matrix [1/s^2] that anchors a free body; internal forces cannot push against it."""


def equilibrium(
    system: System, drive: DriveState, load_factor: float, tolerance: float
) -> tuple[np.ndarray, Linearisation]:
    """Nodal positions [m] [nodes, 2] at rest under load_factor times all loads, and the derivatives there.

    tolerance: largest last correction [m]. Raises SimulationError when no equilibrium is found.
    """
    position = system.nodes.copy()
    still = np.zeros_like(position)
    anchor = _ANCHOR if system.held == 0 else 0.0
    reached, step = 0.0, 1.0
    while reached < 1.0:
        target, trial = min(1.0, reached + step), position.copy()
        for _ in range(15):
            motion = Motion(trial, still, still)
            residual = system.residual(motion, drive, Memory(), load_factor * target)
            line = system.linearise(motion, drive, Memory(), load_factor * target)
            correction = -line.matrix(1.0, 0.0, anchor).factorise().solve(residual[None])[0]
            if not np.isfinite(correction).all() or np.abs(correction).max() > 0.5 * np.ptp(
                system.nodes[:, 0]
            ):
                break
            trial += correction
            if np.abs(correction).max() < tolerance:
                position, reached = trial, target
                break
        if reached < target:
            step *= 0.5
            if step < 1e-3:
                raise SimulationError(
                    f"no static equilibrium was found beyond {reached:.0%} of the loads; expected a body stiff enough "
                    "to carry them: check stiffness, gravity and initial_load_factor"
                )
    return position, system.linearise(Motion(position, still, still), drive, Memory(), load_factor)


def equilibrium_slope(line: Linearisation, residual_slope: np.ndarray) -> np.ndarray:
    """Change of the equilibrium along parameters whose residual slopes are given, [columns, nodes, 2].

    Iterative refinement takes out what a free body's anchor does to it.
    """
    factors, still = _anchored(line).factorise(), np.zeros_like(residual_slope)
    change = -factors.solve(residual_slope)
    for _ in range(2):
        change -= factors.solve(line.along(change, still, still) + residual_slope)
    return change


def equilibrium_multiplier(line: Linearisation, weights: np.ndarray) -> np.ndarray:
    """What a change of the residual [N/m] does to a sum of the equilibrium's positions with weights [nodes, 2]."""
    factors = _anchored(line).factorise()
    multiplier = -factors.solve(weights[None], transposed=True)
    for _ in range(2):
        left = line.pulled_back(multiplier[0])[0] + weights
        multiplier -= factors.solve(left[None], transposed=True)
    return multiplier[0]


def _anchored(line: Linearisation) -> BandMatrix:
    return line.matrix(1.0, 0.0, _ANCHOR if line.system.held == 0 else 0.0)
