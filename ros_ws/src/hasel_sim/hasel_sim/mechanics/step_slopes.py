"""Derivatives of the state after a step by parameters, in all lanes; one factorisation serves all of them."""

import numpy as np

from hasel_sim.mechanics import branch_loops, slope_loops
from hasel_sim.mechanics.balance import balance
from hasel_sim.mechanics.banded import BandMatrix, singular_matrix
from hasel_sim.mechanics.banded_lu import clear_band
from hasel_sim.mechanics.lane_loops import copy_lanes
from hasel_sim.mechanics.law_table import LawTable
from hasel_sim.mechanics.law_terms import add_site_matrix
from hasel_sim.mechanics.linearisation import StrainedSystem
from hasel_sim.mechanics.newton import factorise, solve
from hasel_sim.mechanics.part import Part
from hasel_sim.mechanics.residual_slopes import ResidualSlope, SolidSlope
from hasel_sim.mechanics.state import State, StateSlopes
from hasel_sim.mechanics.system import System
from hasel_sim.simd import lane_tuple


class StepSlopes:
    """Follows the derivatives of a `System`'s state along its steps, exact to the tolerance of the steps.

    parameters: one for every column of the derivatives.
    """

    def __init__(self, system: System, parameters: list[ResidualSlope]) -> None:
        self.system, self.parameters, lanes = system, parameters, system.lanes
        self._lane, self._laws = lane_tuple(lanes), LawTable(system)
        solid, matrix = system.solid, BandMatrix(system.mesh.reach, 2 * system.held, lanes)
        self._body = (*solid.places, solid.muscle, solid.plane_stress), system.mass.masses, system.weight
        shape = matrix.diagonal, matrix.half_bandwidth, matrix.held
        self._matrix = matrix.entries, matrix.reach, shape, np.zeros(1, dtype=bool)
        nodal, points, columns = system.weight.shape, solid.areas.shape, len(parameters)
        self._moved = tuple(np.empty((columns, *nodal)) for _ in range(3))
        self._right = np.empty((columns, *nodal))
        self._padded = np.empty((columns, nodal[0] + matrix.half_bandwidth + 4, 2, lanes))
        self._found = np.empty(nodal), np.empty((*points, 3, lanes))
        self._at_rest = np.zeros((columns, 1, lanes))
        self._no_stress = np.empty((0, *points, 3, lanes))
        self._history = np.empty((columns, *points, 3, lanes))
        self._branch = np.empty((columns, len(solid.branches), *points, 3, lanes))

    def advance(
        self, part: Part, slopes: StateSlopes, by_contraction: np.ndarray, chosen: np.ndarray
    ) -> None:
        """Bring the derivatives, in place, to the end of a step or a part of one in the lanes chosen [lanes].

        by_contraction: derivatives of the contraction [columns, muscles, lanes]. Raises SimulationError where the
        matrix of every lane is singular; the derivatives of a single such lane are no numbers.
        """
        state, drive, c, lane = part.before, part.drive, part.coefficients, self._lane
        moving = slopes.position, slopes.velocity, slopes.acceleration
        strained = StrainedSystem(self.system, part.motion)
        driven = self._driven(part)
        self._laws.linearise(strained, drive, c.matrix_weights)
        self._factorise(part, driven)
        rate, inertia, instead = self._moved
        slope_loops.directions(moving, c.to_balance, self._moved, lane)
        self._right[:] = 0.0
        slope_loops.right_hand_sides(
            part.motion.position,
            self._body,
            driven,
            (rate, inertia),
            np.concatenate([self._at_rest, by_contraction], axis=1),
            self._no_stress if slopes.branch is None else self._carried(slopes, c.at),
            (self._laws.terms[2][0], self._laws.by_rate),
            self._right,
            lane,
        )
        self._laws.add_directions(rate, inertia, self._right)
        if by_contraction.any():
            self._laws.add_contraction(strained, drive, by_contraction, self._right)
        for column, parameter in enumerate(self.parameters):
            parameter.add(part.motion, drive, strained, state, c.at, self._right[column])
        slope_loops.pad(self._right, self._padded, lane)
        solve(self._matrix, self._padded, lane)
        slope_loops.advance(moving, instead, self._padded, c.to_end, chosen, lane)
        if slopes.branch is not None:
            self._advance_branches(part, slopes, chosen)

    def _driven(self, part: Part) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The solid's coefficients, the contraction and what the branches carry, where a step balances."""
        solid, state, at = self.system.solid, part.before, part.coefficients.at
        history = (
            solid.no_history
            if state.branch is None
            else solid.branches.history(state.branch, state.green, at)
        )
        return solid.table(at), np.concatenate([self._at_rest[0], part.drive.contraction]), history

    def _factorise(self, part: Part, driven: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
        """Factors of the matrix of a step at the motion that it found."""
        motion = part.motion.position, part.motion.velocity, part.motion.acceleration
        _, sites, further = self._laws.terms
        band, reach, (diagonal, _, _), _ = self._matrix
        (solid, masses, _), (residual, stress) = self._body, self._found
        clear_band(band, reach, diagonal, self._lane)
        weights, wanted = part.coefficients.matrix_weights, (True, False)
        out = residual, stress, band, diagonal
        balance(motion, solid, driven, further, masses, weights, stress, wanted, out, self._lane)
        if self._laws:
            add_site_matrix(sites, band, diagonal, self._lane)
        bad = np.full(self.system.lanes, -1)
        factorise(self._matrix, bad, self._lane)
        if (bad >= 0).all():
            raise singular_matrix(bad[0])

    def _carried(self, slopes: StateSlopes, at: float | np.ndarray) -> np.ndarray:
        """Changes of the stress that the branches carry to the balance, [columns, elements, points, 3, lanes]."""
        factors = self.system.solid.branches.factors(at)
        branch_loops.history(*factors, slopes.branch, slopes.green, self._history, self._lane)
        return self._history

    def _advance_branches(self, part: Part, slopes: StateSlopes, chosen: np.ndarray) -> None:
        """Once the derivatives of the positions are those of the step's end."""
        solid, step, lane = self.system.solid, part.coefficients.step, self._lane
        green, branch = (
            solid.green_stress_along(solid.gradient(part.after.position), slopes.position),
            self._branch,
        )
        branch_loops.advance(*solid.branches.factors(step), slopes.branch, slopes.green, green, branch, lane)
        for column, parameter in enumerate(self.parameters):
            if isinstance(parameter, SolidSlope):
                _add_branch_parameter(parameter, part.before, part.after, step, branch[column], green[column])
        copy_lanes(green, slopes.green, chosen, lane)
        copy_lanes(branch, slopes.branch, chosen, lane)


def _add_branch_parameter(
    parameter: SolidSlope, before: State, after: State, step, branch: np.ndarray, green: np.ndarray
) -> None:
    lane = lane_tuple(green.shape[-1])
    for solid, sign in parameter.solids:
        own, factors = solid.green_stress(solid.gradient(after.position)), solid.branches.factors(step)
        known = before.branch, before.green, own
        branch_loops.add_parameter(*factors, *known, sign / parameter.width, branch, green, lane)
