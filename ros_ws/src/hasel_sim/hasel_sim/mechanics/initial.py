"""The state in which a run starts, and its derivatives by parameters."""

import numpy as np

from hasel_sim.mechanics.branches import green_stress_direction
from hasel_sim.mechanics.residual_slopes import ForceSlope, ResidualSlope, SolidSlope
from hasel_sim.mechanics.state import State, StateSlopes
from hasel_sim.mechanics.statics import equilibrium, equilibrium_slope
from hasel_sim.mechanics.system import DriveState, Linearisation, Memory, Motion, System

_EQUILIBRIUM_TOLERANCE = 1e-11


def initial_state(
    system: System, drive: DriveState, load_factor: float, parameters: list[ResidualSlope]
) -> tuple[State, StateSlopes]:
    """At rest in equilibrium under load_factor times all loads, about to move under all of them.

    The derivatives have one column per parameter. Raises SimulationError when there is no equilibrium.
    """
    position, line = equilibrium(system, drive, load_factor, _EQUILIBRIUM_TOLERANCE)
    still = np.zeros_like(position)
    state = State(position, still.copy(), still.copy())
    branches = system.solid.branches
    if len(branches):
        state.branch = np.zeros((len(branches), *system.solid.areas.shape, 3))
        state.green = system.solid.green_stress(system.solid.gradient(position))
    motion = Motion(position, still, still)
    by_parameter = _residual_slopes(parameters, motion, drive, line, state)
    scale = np.array([load_factor if isinstance(p, ForceSlope) else 1.0 for p in parameters])
    right = system.held_to_zero(scale[:, None, None] * by_parameter)
    slopes = StateSlopes(equilibrium_slope(line, right), np.zeros_like(right), np.zeros_like(right))
    if len(branches):
        _branch_slopes(system, state, parameters, slopes)

    inertia = line.matrix(0.0, 0.0, 1.0).factorise()
    state.acceleration = -inertia.solve(system.residual(motion, drive, Memory())[None])[0]
    full = line.along(slopes.position, slopes.velocity, slopes.acceleration) + by_parameter
    slopes.acceleration = -inertia.solve(system.held_to_zero(full))
    return state, slopes


def _residual_slopes(
    parameters: list[ResidualSlope], motion: Motion, drive: DriveState, line: Linearisation, state: State
) -> np.ndarray:
    out = np.zeros((len(parameters), *motion.position.shape))
    for column, parameter in enumerate(parameters):
        parameter.add(motion, drive, line, state, 1e-9, out[column])
    return out


def _branch_slopes(
    system: System, state: State, parameters: list[ResidualSlope], slopes: StateSlopes
) -> None:
    solid = system.solid
    F = solid.gradient(state.position)
    slopes.branch = np.zeros((len(parameters), *state.branch.shape))
    slopes.green = np.zeros((len(parameters), *state.green.shape))
    for column, parameter in enumerate(parameters):
        change = solid.gradient(slopes.position[column])
        green_stress_direction(F, change, solid.shear, solid.linear_lame, slopes.green[column])
        if isinstance(parameter, SolidSlope):
            for other, sign in ((parameter.more, 1.0), (parameter.less, -1.0)):
                slopes.green[column] += (
                    sign / parameter.width * other.green_stress(other.gradient(state.position))
                )
