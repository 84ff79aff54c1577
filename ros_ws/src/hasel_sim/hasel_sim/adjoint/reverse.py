# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The way back through a step and through the first state: from weights after it to weights before it.

Weights are the derivatives of what is optimised by every number of a state, in the shape of a `State`. A step solves
R(x(a1), c, p) = 0 for the end-of-step acceleration a1. With A = dR/da1 and g the weights that reach a1,
the multiplier mu = -A^-T g gives every derivative: mu . dR/dc by the contraction, mu . dR/dp by a parameter, and
(dR/dx)^T mu by the state before (the discrete adjoint; e.g. Giles and Pierce, Flow, Turbulence and Combustion 65
(2000) 393).
"""

from collections.abc import Callable

import numpy as np

from hasel_sim.dynamics import step_derivatives
from hasel_sim.dynamics.generalised_alpha import SolvedStep
from hasel_sim.dynamics.parameter_columns import ResidualColumns, ResidualSlope
from hasel_sim.dynamics.statics import equilibrium_multiplier, start_of_motion
from hasel_sim.dynamics.system import DeformedSystem, LawTable, System, linearise
from hasel_sim.mechanics.banded import singular_matrix
from hasel_sim.mechanics.constitutive import times_symmetric
from hasel_sim.mechanics.solid import Solid
from hasel_sim.mechanics.state import Memory, Motion, State
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.simd import lane_tuple


def green_pulled_back(solid: Solid, position: np.ndarray, weights: np.ndarray) -> np.ndarray:
    """What weights of C : E [elements, points, 3, 1] mean for the positions, [nodes, 2, 1]."""
    shear, lame = solid.shear[:, None], solid.linear_lame[:, None]
    wxx, wyy, wxy = np.moveaxis(weights, -2, 0)
    trace = lame * (wxx + wyy)
    F = solid.gradient(position)
    P = times_symmetric(F, trace + 2 * shear * wxx, trace + 2 * shear * wyy, shear * wxy)
    out = np.zeros_like(position)
    # weights of F act as the forces of a stress do, per area
    solid.add_force(P / (solid.areas[..., None] * solid.stretch)[:, :, None], out)
    return out


def history_pulled_back(solid: Solid, F: np.ndarray, multiplier: np.ndarray) -> np.ndarray:
    """What a multiplier of the residual [nodes, 2, 1] means for the branches' history, [elements, points, 3, 1]."""
    a, b, c, d = np.moveaxis(F, -2, 0)
    m0, m1, m2, m3 = np.moveaxis(solid.gradient(multiplier), -2, 0)
    change = np.stack([a * m0 + c * m2, b * m1 + d * m3, a * m1 + c * m3 + b * m0 + d * m2], axis=-2)
    return (solid.areas[..., None] * solid.stretch)[:, :, None] * change


class StepBack:
    """The multiplier of a step, and its products with the transposed derivatives of the residual.

    With A = x K + v C + a M the matrix of the step and g the weights that reach its end-of-step acceleration, the
    multiplier solves A^T mu = -g, so that K^T mu = -(g + v C^T mu + a M^T mu) / x needs no stiffness.
    """

    def __init__(self, system: System) -> None:
        self.system, self._laws, matrix = system, LawTable(system), system.band_matrix()
        self._matrix = matrix.for_loops
        nodal, points, lanes = system.weight.shape, system.solid.areas.shape, system.lanes
        self._found = np.empty(nodal), np.empty((*points, 3, lanes))
        self._weights = np.empty((1, nodal[0] + matrix.padding, 2, lanes))
        self._moved = np.zeros((2, *nodal)), np.zeros((2, *nodal))
        self._pulled = np.empty((2, *nodal))
        self._none = np.zeros((2, 1 + system.solid.muscle.max(), lanes)), np.empty((0, *points, 3, lanes))

    def pull(
        self, step: SolvedStep, at: DeformedSystem, reached: np.ndarray
    ) -> tuple[np.ndarray, tuple[np.ndarray, np.ndarray, np.ndarray]]:
        """The multiplier [nodes, 2, lanes], and with it the residual's derivatives by position, velocity, acceleration.

        at: the system at the step's motion; reached: weights of the end-of-step acceleration. Raises SimulationError
        where the matrix of the step is singular.
        """
        nodes, c, bad = len(reached), step.coefficients, np.full(self.system.lanes, -1)
        motion, drive, solid = step.motion, step.drive, self.system.solid
        history = self.system.memory(step.before, c.at).history
        self._laws.linearise(at, drive, c.matrix_weights)
        _, sites, further = self._laws.terms
        at_step = (
            (motion.position, motion.velocity, motion.acceleration),
            c.matrix_weights,
            self.system.for_loops,
            (solid.table(c.at), drive.signals, solid.no_history if history is None else history),
            (sites, further, np.ascontiguousarray(self._laws.by_rate.swapaxes(2, 3))),
            self._found,
            self._matrix,
        )
        self._weights[0, :nodes] = -reached
        lane = lane_tuple(self.system.lanes)
        step_derivatives.pull_back(at_step, self._weights, self._moved, *self._none, self._pulled, bad, lane)
        if (bad >= 0).all():
            raise singular_matrix(bad[0])
        multiplier = self._weights[0, :nodes].copy()
        velocity, acceleration = self._pulled.copy()
        self._laws.add_pulled_back(multiplier, velocity, acceleration)
        position = -(reached + c.velocity * velocity + c.acceleration * acceleration) / c.position
        for by in (position, velocity, acceleration):
            by[: self.system.held] = 0.0
        return multiplier, (position, velocity, acceleration)


def reverse_step(
    back: StepBack, step: SolvedStep, weights: State, columns: ResidualColumns
) -> tuple[State, np.ndarray, np.ndarray]:
    """Weights of the state before, the contraction [muscles] and the parameters [n], from those of the state after."""
    before, after, motion, drive, c = step.before, step.after, step.motion, step.drive, step.coefficients
    solid, at = back.system.solid, DeformedSystem(back.system, motion)
    position = weights.position
    if weights.branch is not None:
        left, gain = solid.branches.factors(c.step)
        green = weights.green + np.tensordot(gain[:, 0], weights.branch, 1)
        position = position + green_pulled_back(solid, after.position, green)
    reached = c.end_position * position + c.end_velocity * weights.velocity + weights.acceleration
    multiplier, (by_position, by_velocity, by_acceleration) = back.pull(step, at, reached)
    earlier = State(
        position + by_position,
        weights.velocity + c.step * position + c.position_v * by_position + by_velocity,
        c.end_position_a * position
        + c.end_velocity_a * weights.velocity
        + c.position_a * by_position
        + c.velocity_a * by_velocity
        + c.acceleration_a * by_acceleration,
    )
    if weights.branch is not None:
        history = history_pulled_back(solid, at.F, multiplier)
        kept, gained = solid.branches.factors(c.at)
        earlier.branch = left[:, None, None, None] * weights.branch + np.multiply.outer(kept[:, 0], history)
        earlier.green = -np.tensordot(gain[:, 0], weights.branch, 1) - gained.sum() * history
    by_muscle = at.by_contraction(drive)
    contraction = by_muscle.reshape(len(by_muscle), multiplier.size) @ multiplier.ravel()
    by_parameter = _times(columns.at(motion, drive, before, c.at), multiplier)
    if weights.branch is not None:

        def advanced(solid: Solid, green: np.ndarray) -> np.ndarray:
            return solid.branches.advance(before.branch, before.green, green, c.step)

        of_branches = weights.green, weights.branch
        for column, parameter in enumerate(columns.parameters):
            by_parameter[column] += _by_solids(parameter, after.position, advanced, *of_branches)
    return earlier, contraction, by_parameter


def reverse_start(
    prepared: PreparedRun, state: State, weights: State, columns: ResidualColumns
) -> np.ndarray:
    """Weights of the parameters [n] from those of the first state, which is in static equilibrium or simply given."""
    system, drive, load_factor = prepared.stepper.system, prepared.start_drive, prepared.load_factor
    motion, line, inertia = start_of_motion(system, state, drive)
    multiplier = -inertia.solve(weights.acceleration[None], transposed=True)[0]
    out = _times(columns.at(motion, drive, state, 0.0), multiplier)
    position = weights.position + line.pulled_back(multiplier)[0]
    if weights.branch is not None:
        branch = weights.branch + history_pulled_back(system.solid, line.F, multiplier)
        share = system.solid.branches.share[:, 0]
        position += green_pulled_back(
            system.solid, state.position, weights.green + np.tensordot(share, branch, 1)
        )
        for column, parameter in enumerate(columns.parameters):
            out[column] += _by_solids(
                parameter,
                state.position,
                lambda solid, green: solid.branches.at_start(green),
                weights.green,
                branch,
            )
    if prepared.held_shape is not None:
        return out
    motion = Motion.at_rest(state.position)
    line = linearise(system, motion, drive, Memory(), load_factor)
    multiplier = equilibrium_multiplier(line, system.held_to_zero(position[None])[0])
    return out + _times(columns.at(motion, drive, None, 0.0, load_factor), multiplier)


def _times(columns: np.ndarray, multiplier: np.ndarray) -> np.ndarray:
    """Products of every column [columns, nodes, 2, lanes] with a multiplier, [columns]."""
    return columns.reshape(len(columns), multiplier.size) @ multiplier.ravel()


def _by_solids(
    parameter: ResidualSlope,
    position: np.ndarray,
    branch: Callable[[Solid, np.ndarray], np.ndarray],
    of_green: np.ndarray,
    of_branch: np.ndarray,
) -> float:
    """By way of what the branches hold; of_green, of_branch: weights of C : E and of the branches' stresses."""
    total = 0.0
    for solid, factor in parameter.solids:
        green = solid.green_stress(solid.gradient(position))
        total += factor[0] * ((of_green * green).sum() + (of_branch * branch(solid, green)).sum())
    return total
