"""The linear system of a step's derivatives in two compiled calls, around what effects and parameters add to it; of the
way back, in one.

Arguments are those of `march`, `balance` and `slope_loops`. Calling each of their loops from Python takes a twentieth
longer.
"""

from numba import njit

from hasel_sim.mechanics import slope_loops
from hasel_sim.mechanics.balance import balance
from hasel_sim.mechanics.banded_lu import clear_band
from hasel_sim.mechanics.law_terms import add_site_matrix
from hasel_sim.mechanics.newton import factorise, solve, solve_transposed


@njit(cache=True, error_model="numpy")
def _factorise(at_step, bad, lane):
    motion, weights, body, drive, laws, found, matrix = at_step
    sites, further, _ = laws
    residual, stress = found
    band, reach, (diagonal, _, _), _ = matrix
    clear_band(band, reach, diagonal, lane)
    out = residual, stress, band, diagonal
    balance(motion, body[0], drive, further, body[1], weights, stress, (True, False), out, lane)
    add_site_matrix(sites, band, diagonal, lane)
    factorise(matrix, bad, lane)


@njit(cache=True, error_model="numpy")
def begin(at_step, moving, to_balance, moved, by_contraction, carried, right, bad, lane):
    """Factorise the matrix of a step at the motion that it found, and begin the right-hand sides.

    at_step: of a `StepMatrix`; moving: derivatives of position, velocity and acceleration before the step; to_balance:
    weights to the balance; moved: takes what `slope_loops.directions` tells; carried: change of the branches' stress,
    or an empty first axis; right [columns, nodes, 2, lanes]: takes the right-hand sides.
    """
    _factorise(at_step, bad, lane)
    motion, _, body, drive, (_, (places, _, _), by_rate), _, _ = at_step
    slope_loops.directions(moving, to_balance, moved, lane)
    right[:] = 0.0
    slope_loops.right_hand_sides(
        motion[0],
        body,
        drive,
        (moved[0], moved[1]),
        by_contraction,
        carried,
        (places, by_rate),
        right,
        lane,
    )


@njit(cache=True, error_model="numpy")
def end(matrix, right, padded, moving, instead, to_end, chosen, lane):
    """Solve for all right-hand sides, and bring the derivatives to the end of the step in the lanes chosen [lanes]."""
    slope_loops.pad(right, padded, lane)
    solve(matrix, padded, lane)
    slope_loops.advance(moving, instead, padded, to_end, chosen, lane)


@njit(cache=True, error_model="numpy")
def pull_back(at_step, weights, moved, by_contraction, carried, pulled, bad, lane):
    """Solve with the transposed matrix of a step, and pull the solution back to the rate and to the acceleration.

    weights [1, more, 2, lanes]: of the end-of-step acceleration, replaced by the solution; moved: two arrays
    [2, nodes, 2, lanes], zero but for where the solution goes; by_contraction, carried: none; pulled
    [2, nodes, 2, lanes]: takes damping and mass times the solution, both matrices transposed.
    """
    _factorise(at_step, bad, lane)
    motion, _, body, drive, (_, (places, _, _), by_rate), _, matrix = at_step
    solve_transposed(matrix, weights, lane)
    nodes = pulled.shape[1]
    moved[0][0], moved[1][1] = weights[0, :nodes], weights[0, :nodes]
    pulled[:] = 0.0
    slope_loops.right_hand_sides(
        motion[0], body, drive, moved, by_contraction, carried, (places, by_rate), pulled, lane
    )
