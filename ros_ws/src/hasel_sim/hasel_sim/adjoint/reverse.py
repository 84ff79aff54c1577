"""The way back: from weights after a step to weights before it, and from the first state to what it came from.

A step solves R(x(a1), c, p) = 0 for the end-of-step acceleration a1. With A = dR/da1 and g the weights that reach a1,
the multiplier mu = -A^-T g gives every derivative: mu . dR/dc by the contraction, mu . dR/dp by a parameter, and
(dR/dx)^T mu by the state before (the discrete adjoint; e.g. Giles and Pierce, Flow, Turbulence and Combustion 65
(2000) 393).
"""

import numpy as np

from hasel_sim.adjoint.step_back import StepBack
from hasel_sim.adjoint.weights import StateWeights, green_pulled_back, history_pulled_back
from hasel_sim.mechanics.initial import start_of_motion
from hasel_sim.mechanics.linearisation import StrainedSystem, linearise
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.residual_columns import ResidualColumns
from hasel_sim.mechanics.residual_slopes import ResidualSlope, solids_of
from hasel_sim.mechanics.state import State
from hasel_sim.mechanics.statics import equilibrium_multiplier
from hasel_sim.mechanics.stepper import Part
from hasel_sim.mechanics.system import System


def reverse_step(
    back: StepBack,
    part: Part,
    weights: StateWeights,
    columns: ResidualColumns,
) -> tuple[StateWeights, np.ndarray, np.ndarray]:
    """Weights of the state before, the contraction [muscles] and the parameters [n], from those of the state after."""
    before, after, motion, drive, c = part.before, part.after, part.motion, part.drive, part.coefficients
    solid, at = back.system.solid, StrainedSystem(back.system, motion)
    position = weights.position
    if weights.branch is not None:
        left, gain = solid.branches.factors(c.step)
        green = weights.green + np.tensordot(gain[:, 0], weights.branch, 1)
        position = position + green_pulled_back(solid, after.position, green)
    reached = c.end_position * position + c.end_velocity * weights.velocity + weights.acceleration
    multiplier, (by_position, by_velocity, by_acceleration) = back.pull(part, at, reached)
    earlier = StateWeights(
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
        for column, parameter in enumerate(columns.parameters):
            by_parameter[column] += _by_branch_parameter(parameter, before, after, c.step, weights)
    return earlier, contraction, by_parameter


def reverse_start(
    system: System,
    state: State,
    drive: DriveState,
    load_factor: float,
    in_equilibrium: bool,
    weights: StateWeights,
    columns: ResidualColumns,
) -> np.ndarray:
    """Weights of the parameters [n] from those of the first state, which is in static equilibrium or simply given."""
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
        out += [_by_first_stress(parameter, state, weights.green, branch) for parameter in columns.parameters]
    if not in_equilibrium:
        return out
    still = np.zeros_like(position)
    motion = Motion(state.position, still, still)
    line = linearise(system, motion, drive, Memory(), load_factor)
    multiplier = equilibrium_multiplier(line, system.held_to_zero(position[None])[0])
    return out + _times(columns.at(motion, drive, None, 0.0, load_factor), multiplier)


def _times(columns: np.ndarray, multiplier: np.ndarray) -> np.ndarray:
    """Products of every column [columns, nodes, 2, lanes] with a multiplier, [columns]."""
    return columns.reshape(len(columns), multiplier.size) @ multiplier.ravel()


def _by_branch_parameter(
    parameter: ResidualSlope, before: State, after: State, step: float, weights: StateWeights
) -> float:
    total = 0.0
    for solid, factor in solids_of(parameter):
        green = solid.green_stress(solid.gradient(after.position))
        branch = solid.branches.advance(before.branch, before.green, green, step)
        total += factor[0] * ((weights.green * green).sum() + (weights.branch * branch).sum())
    return total


def _by_first_stress(
    parameter: ResidualSlope, state: State, of_green: np.ndarray, of_branch: np.ndarray
) -> float:
    """By way of what the branches start with; of_green, of_branch: weights of C : E and of the branches' stresses."""
    total = 0.0
    for solid, factor in solids_of(parameter):
        green = solid.green_stress(solid.gradient(state.position))
        total += factor[0] * ((of_green * green).sum() + (of_branch * solid.branches.at_start(green)).sum())
    return total
