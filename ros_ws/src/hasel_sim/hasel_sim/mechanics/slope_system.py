"""The linear system of a step's derivatives in two compiled calls, around what effects and parameters add to it.

Arguments are those of `march`, `balance` and `slope_loops`. Calling each of their loops from Python takes a twentieth
longer.
"""

from numba import njit

from hasel_sim.mechanics import slope_loops
from hasel_sim.mechanics.balance import balance
from hasel_sim.mechanics.banded_lu import clear_band
from hasel_sim.mechanics.law_terms import add_site_matrix
from hasel_sim.mechanics.newton import factorise, solve


@njit(cache=True, error_model="numpy")
def begin(
    motion, moving, scheme, body, drive, laws, found, matrix, moved, by_contraction, carried, right, bad, lane
):
    """Factorise the matrix of a step at the motion that it found, and begin the right-hand sides.

    motion: position, velocity and acceleration at the balance; moving: their derivatives before the step; scheme:
    weights to the balance and of the matrix; laws: sites, further stress, and its derivative by the rate; found: room
    for a residual and a stress, which are not used; moved: takes what `slope_loops.directions` tells; carried: change
    of the branches' stress, or an empty first axis; right [columns, nodes, 2, lanes]: takes the right-hand sides.
    """
    to_balance, weights = scheme
    sites, further, by_rate = laws
    residual, stress = found
    band, reach, (diagonal, _, _), _ = matrix
    clear_band(band, reach, diagonal, lane)
    out = residual, stress, band, diagonal
    balance(motion, body[0], drive, further, body[1], weights, stress, (True, False), out, lane)
    add_site_matrix(sites, band, diagonal, lane)
    factorise(matrix, bad, lane)
    slope_loops.directions(moving, to_balance, moved, lane)
    right[:] = 0.0
    rates = further[0], by_rate
    slope_loops.right_hand_sides(
        motion[0], body, drive, (moved[0], moved[1]), by_contraction, carried, rates, right, lane
    )


@njit(cache=True, error_model="numpy")
def end(matrix, right, padded, moving, instead, to_end, chosen, lane):
    """Solve for all right-hand sides, and bring the derivatives to the end of the step in the lanes chosen [lanes]."""
    slope_loops.pad(right, padded, lane)
    solve(matrix, padded, lane)
    slope_loops.advance(moving, instead, padded, to_end, chosen, lane)
