"""The state in which a run starts, and its derivatives by parameters."""

import numpy as np

from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.banded import BandFactors
from hasel_sim.mechanics.linearisation import Linearisation, linearise
from hasel_sim.mechanics.motion import DriveState, Memory, Motion
from hasel_sim.mechanics.residual_columns import ResidualColumns
from hasel_sim.mechanics.residual_slopes import ResidualSlope, solids_of
from hasel_sim.mechanics.state import State, StateSlopes
from hasel_sim.mechanics.statics import equilibrium, equilibrium_slope
from hasel_sim.mechanics.strain import times_symmetric
from hasel_sim.mechanics.system import System

_EQUILIBRIUM_TOLERANCE = 1e-11


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
    still = np.zeros_like(position)
    state = State(position, still.copy(), still.copy())
    branches = system.solid.branches
    if len(branches):
        state.green = system.solid.green_stress(system.solid.gradient(position))
        state.branch = branches.at_start(state.green)
    motion = Motion(position, still, still)
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
    motion = Motion(state.position, state.velocity, state.acceleration)
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
    still = np.zeros_like(position)
    return position, linearise(system, Motion(position, still, still), drive, Memory())


def _branch_slopes(
    system: System, state: State, parameters: list[ResidualSlope], slopes: StateSlopes
) -> None:
    solid = system.solid
    slopes.branch = np.zeros((len(parameters), *state.branch.shape))
    slopes.green = solid.green_stress_along(solid.gradient(state.position), slopes.position)
    for column, parameter in enumerate(parameters):
        slopes.branch[column] = solid.branches.at_start(slopes.green[column])
        for other, factor in solids_of(parameter):
            green = other.green_stress(other.gradient(state.position))
            slopes.green[column] += factor * green
            slopes.branch[column] += factor * other.branches.at_start(green)


def _forces_of_changed_memory(system: System, line: Linearisation, change: np.ndarray) -> np.ndarray:
    """Nodal forces [columns, nodes, 2, 1] of changes of the branches' stresses [columns, branches, ...]."""
    out = np.zeros((len(change), *system.nodes.shape, 1))
    for column, stress in enumerate(change.sum(axis=1)):
        system.solid.add_force(times_symmetric(line.F, *np.moveaxis(stress, -2, 0)), out[column])
    return out
