# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Static equilibrium by Newton's method, and the state in which a run starts, with its derivatives by parameters.

What is out of balance at first is taken away step by step where needed. A free body that nothing holds has no
equilibrium under loads that do not cancel: it sets off as a rigid body. It starts in the shape that these loads and its
own inertia bend it into ("inertia relief"), its centre and heading unchanged.
"""

from collections.abc import Callable

import numpy as np

from hasel_sim.dynamics.parameter_columns import ResidualColumns, ResidualSlope
from hasel_sim.dynamics.system import Linearisation, System, linearise
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.banded import BandFactors
from hasel_sim.mechanics.constitutive import times_symmetric
from hasel_sim.mechanics.state import DriveState, Memory, Motion, State, StateSlopes

_HELD = 1e-3
"""Stiffness over mass [1/s^2] above which the surroundings hold a rigid motion of a free body."""
_SMALLEST_SHARE = 1e-3
_MOST_ITERATIONS = 15
_EQUILIBRIUM_TOLERANCE = 1e-11


def equilibrium(
    system: System, drive: DriveState, load_factor: float, tolerance: float
) -> tuple[np.ndarray, Linearisation]:
    """Nodal positions [m] [nodes, 2, 1] at rest under load_factor times all loads, and the derivatives there.

    system: of one lane, as everywhere here; tolerance: largest last correction [m]. Raises SimulationError when no
    equilibrium is found.
    """
    position = system.nodes[..., None].copy()

    def linearised(at: np.ndarray) -> tuple[np.ndarray, Linearisation]:
        motion = Motion.at_rest(at)
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
    linearised: Callable[[np.ndarray], tuple[np.ndarray, Linearisation]],
    position: np.ndarray,
    borne: np.ndarray,
    inertia: np.ndarray,
    tolerance: float,
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
            small = self._conditions(answers).T
            pins = np.arange(len(self._pins))
            small[pins, pins] += 1.0
            try:
                shares = np.linalg.solve(small, self._conditions(out).T)
            except np.linalg.LinAlgError:
                raise SimulationError("nothing holds the body in the shape that was tried") from None
            out -= np.tensordot(shares.T, answers, 1)
        return out

    def _conditions(self, fields: np.ndarray) -> np.ndarray:
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


def initial_state(
    system: System,
    drive: DriveState,
    load_factor: float,
    parameters: list[ResidualSlope],
    held_shape: np.ndarray | None = None,
) -> tuple[State, StateSlopes]:
    """At rest in equilibrium under load_factor times all loads, or in a held shape [m] [nodes, 2], about to move.

    Of one lane, whose axis is the last of every array. The derivatives have one column per parameter. Raises
    SimulationError when there is no equilibrium, or for a shape of another mesh.
    """
    if held_shape is None:
        position, line = equilibrium(system, drive, load_factor, _EQUILIBRIUM_TOLERANCE)
    else:
        position, line = _held(system, drive, held_shape)
    motion = Motion.at_rest(position)
    state = State(position, np.zeros_like(position), np.zeros_like(position))
    branches = system.solid.branches
    if len(branches):
        state.green = system.solid.green_stress(system.solid.gradient(position))
        state.branch = branches.at_start(state.green)
    columns = ResidualColumns(system, parameters)
    right = columns.at(motion, drive, None, 0.0, load_factor)
    moved = equilibrium_slope(line, right) if held_shape is None else np.zeros_like(right)
    slopes = StateSlopes(moved, np.zeros_like(right), np.zeros_like(right))
    if len(branches):
        _branch_slopes(system, state, parameters, slopes)

    memory = system.memory(state)
    line = linearise(system, motion, drive, memory)
    state.acceleration = (
        -line.matrix(0.0, 0.0, 1.0).factorise().solve(system.residual(motion, drive, memory)[None])[0]
    )
    if parameters:
        motion, line, inertia = start_of_motion(system, state, drive)
        change = line.along(slopes.position, slopes.velocity, slopes.acceleration)
        change += columns.at(motion, drive, state, 0.0)
        if slopes.branch is not None:
            change += system.held_to_zero(_forces_of_changed_memory(system, line, slopes.branch))
        slopes.acceleration = -inertia.solve(change)
    return state, slopes


def start_of_motion(
    system: System, state: State, drive: DriveState
) -> tuple[Motion, Linearisation, BandFactors]:
    """The motion with which a run starts, the derivatives there, and the factors of its inertia."""
    motion = state.motion
    line = linearise(system, motion, drive, system.memory(state))
    return motion, line, line.matrix(0.0, 0.0, 1.0).factorise()


def _held(system: System, drive: DriveState, shape: np.ndarray) -> tuple[np.ndarray, Linearisation]:
    if shape.shape != system.nodes.shape:
        raise SimulationError(
            f"the initial shape has the size {shape.shape}; expected {system.nodes.shape}, one position per node: take "
            "it from a simulation with the same body and mesh density"
        )
    position = shape[..., None].copy()
    position[: system.held, :, 0] = system.nodes[: system.held]
    return position, linearise(system, Motion.at_rest(position), drive, Memory())


def _branch_slopes(
    system: System, state: State, parameters: list[ResidualSlope], slopes: StateSlopes
) -> None:
    solid = system.solid
    slopes.branch = np.zeros((len(parameters), *state.branch.shape))
    slopes.green = solid.green_stress_along(solid.gradient(state.position), slopes.position)
    for column, parameter in enumerate(parameters):
        slopes.branch[column] = solid.branches.at_start(slopes.green[column])
        for other, factor in parameter.solids:
            green = other.green_stress(other.gradient(state.position))
            slopes.green[column] += factor * green
            slopes.branch[column] += factor * other.branches.at_start(green)


def _forces_of_changed_memory(system: System, line: Linearisation, change: np.ndarray) -> np.ndarray:
    """Nodal forces [columns, nodes, 2, 1] of changes of the branches' stresses [columns, branches, ...]."""
    out = np.zeros((len(change), *system.nodes.shape, 1))
    for column, stress in enumerate(change.sum(axis=1)):
        system.solid.add_force(times_symmetric(line.F, *np.moveaxis(stress, -2, 0)), out[column])
    return out
