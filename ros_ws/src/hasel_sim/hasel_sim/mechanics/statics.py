"""Static equilibrium by Newton's method; what is out of balance at first is taken away step by step where needed.

A free body that nothing holds has no equilibrium under loads that do not cancel: it sets off as a rigid body. It starts
in the shape that these loads and its own inertia bend it into ("inertia relief"), its centre and heading unchanged.
"""

import numpy as np

from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.linearisation import Linearisation, linearise
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.system import System

_HELD = 1e-3
"""Stiffness over mass [1/s^2] above which the surroundings hold a rigid motion of a free body."""
_SMALLEST_SHARE = 1e-3
_MOST_ITERATIONS = 15


def equilibrium(
    system: System, drive: DriveState, load_factor: float, tolerance: float
) -> tuple[np.ndarray, Linearisation]:
    """Nodal positions [m] [nodes, 2, 1] at rest under load_factor times all loads, and the derivatives there.

    system: of one lane, as everywhere here; tolerance: largest last correction [m]. Raises SimulationError when no
    equilibrium is found.
    """
    position = system.nodes[..., None].copy()
    still = np.zeros_like(position)

    def linearised(at: np.ndarray) -> tuple[np.ndarray, Linearisation]:
        motion = Motion(at, still, still)
        residual = system.residual(motion, drive, Memory(), load_factor)
        return residual, linearise(system, motion, drive, Memory(), load_factor)

    first, line = linearised(position)
    inertia = _inertia_of_unheld_motions(line)
    reached, step = 0.0, 1.0
    while reached < 1.0:
        target = min(1.0, reached + step)
        found = _balanced(linearised, position.copy(), (1.0 - target) * first, inertia, tolerance)
        if found is not None:
            position, reached, step = found, target, 2.0 * step
            continue
        step = 0.5 * (target - reached)
        if step < _SMALLEST_SHARE:
            raise SimulationError(
                f"no static equilibrium was found beyond {reached:.0%} of the loads; expected a body stiff enough "
                "to carry them: check stiffness, gravity and initial_load_factor"
            )
    return position, linearised(position)[1]


def _balanced(
    linearised, position: np.ndarray, borne: np.ndarray, inertia: np.ndarray, tolerance: float
) -> np.ndarray | None:
    """Positions at which the residual is `borne`, by Newton's method from others; None where it does not converge."""
    for _ in range(_MOST_ITERATIONS):
        residual, line = linearised(position)
        try:
            correction = -StaticFactors(line, inertia).solve((residual - borne)[None])[0]
        except (
            SimulationError
        ):  # a trial shape beyond a limit point: a smaller share of the loads comes first
            return None
        size = np.abs(correction).max()
        if not size <= 0.5 * np.ptp(line.system.nodes[:, 0]):
            return None
        position += correction
        if size < tolerance:
            return position
    return None


def equilibrium_slope(line: Linearisation, residual_slope: np.ndarray) -> np.ndarray:
    """Change of the equilibrium along parameters whose residual slopes are given, [columns, nodes, 2, 1]."""
    if len(residual_slope) == 0:
        return residual_slope
    factors, still = StaticFactors(line, _inertia_of_unheld_motions(line)), np.zeros_like(residual_slope)
    change = -factors.solve(residual_slope)
    for _ in range(2):
        change -= factors.solve(line.along(change, still, still) + residual_slope)
    return change


def equilibrium_multiplier(line: Linearisation, weights: np.ndarray) -> np.ndarray:
    """What a change of the residual [N/m] does to a sum of the equilibrium's positions with weights [nodes, 2, 1]."""
    factors = StaticFactors(line, _inertia_of_unheld_motions(line))
    multiplier = -factors.solve(weights[None], transposed=True)
    for _ in range(2):
        left = line.pulled_back(multiplier[0])[0] + weights
        multiplier -= factors.solve(left[None], transposed=True)
    return multiplier[0]


class StaticFactors:
    """Solves K x + B a = b with B' x = 0: a body whose unheld rigid motions are held by their inertia B.

    inertia: B [motions, nodes, 2, 1]. The band matrix of a free body is pinned at three unknowns to be regular; a small
    dense system takes the pins out again (Sherman, Morrison and Woodbury).
    """

    def __init__(self, line: Linearisation, inertia: np.ndarray) -> None:
        matrix, nodes = line.matrix(1.0, 0.0, 0.0), line.system.nodes
        self._pins, self._inertia = [], inertia
        if line.system.held == 0:
            self._pins = [0, 1, 2 * int(np.argmax(np.abs(nodes[:, 0] - nodes[0, 0]))) + 1]
        stiffness = matrix.entries[self._pins, matrix.diagonal, 0].copy()
        matrix.entries[self._pins, matrix.diagonal, 0] += stiffness
        self._factors = matrix.factorise()
        self._columns = np.zeros((len(self._pins) + len(inertia), *nodes.shape, 1))
        for column, (pin, strength) in enumerate(zip(self._pins, stiffness, strict=True)):
            self._columns[column].flat[pin] = -strength
        self._columns[len(self._pins) :] = inertia

    def solve(self, right: np.ndarray, transposed: bool = False) -> np.ndarray:
        """Solution for each right-hand side [columns, nodes, 2, 1]."""
        out = self._factors.solve(right, transposed)
        if len(self._columns):
            answers = self._factors.solve(self._columns, transposed)
            small = self._seen(answers).T
            pins = np.arange(len(self._pins))
            small[pins, pins] += 1.0
            try:
                shares = np.linalg.solve(small, self._seen(out).T)
            except np.linalg.LinAlgError:
                raise SimulationError("nothing holds the body in the shape that was tried") from None
            out -= np.tensordot(shares.T, answers, 1)
        return out

    def _seen(self, fields: np.ndarray) -> np.ndarray:
        """The pinned unknowns and the weighted rigid motions of fields, [columns, conditions]."""
        pinned = [fields[:, pin // 2, pin % 2, 0] for pin in self._pins]
        return np.stack([*pinned, *(np.tensordot(fields, motion, 3) for motion in self._inertia)], axis=1)


def _inertia_of_unheld_motions(line: Linearisation) -> np.ndarray:
    """Mass times those rigid motions of a free body that no force around it resists, [motions, nodes, 2, 1]."""
    system = line.system
    if system.held:
        return np.zeros((0, *system.nodes.shape, 1))
    lumped = system.mass.lumped
    arm = system.nodes - lumped @ system.nodes / lumped.sum()
    radius = np.sqrt(lumped @ (arm**2).sum(axis=1) / lumped.sum())
    turn = np.stack([-arm[:, 1], arm[:, 0]], axis=1) / radius
    motions = np.stack([np.ones_like(arm) * [1.0, 0.0], np.ones_like(arm) * [0.0, 1.0], turn])[..., None]
    stiffness = np.einsum("indl,jndl->ij", motions, line.force_along(motions)) / lumped.sum()
    unheld = []
    for motion in range(3):
        own = stiffness[motion, motion]
        if own > _HELD:  # what is left of the others' stiffness once this one is free to give way
            stiffness = stiffness - np.outer(stiffness[:, motion], stiffness[motion]) / own
        else:
            unheld.append(motion)
    return system.mass.product(motions[unheld])
