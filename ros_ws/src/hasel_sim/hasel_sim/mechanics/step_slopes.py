"""Derivatives of the state after a step by parameters, in all lanes; one factorisation serves all of them."""

import numpy as np

from hasel_sim.mechanics import branch_loops, slope_system
from hasel_sim.mechanics.lane_loops import copy_lanes
from hasel_sim.mechanics.linearisation import StrainedSystem
from hasel_sim.mechanics.part import Part
from hasel_sim.mechanics.residual_slopes import ResidualSlope, SolidSlope
from hasel_sim.mechanics.state import State, StateSlopes
from hasel_sim.mechanics.step_matrix import StepMatrix
from hasel_sim.mechanics.system import System
from hasel_sim.simd import lane_tuple


class StepSlopes:
    """Follows the derivatives of a `System`'s state along its steps, exact to the tolerance of the steps.

    parameters: one for every column of the derivatives.
    """

    def __init__(self, system: System, parameters: list[ResidualSlope]) -> None:
        self.system, self.parameters, lanes = system, parameters, system.lanes
        self._lane, self._matrix = lane_tuple(lanes), StepMatrix(system)
        nodal, points, columns = system.weight.shape, system.solid.areas.shape, len(parameters)
        self._moved = tuple(np.empty((columns, *nodal)) for _ in range(3))
        self._right = np.empty((columns, *nodal))
        self._padded = np.empty((columns, nodal[0] + self._matrix.more, 2, lanes))
        self._at_rest = np.zeros((columns, 1, lanes))
        self._no_stress = np.empty((0, *points, 3, lanes))
        self._history = np.empty((columns, *points, 3, lanes))
        self._branch = np.empty((columns, len(system.solid.branches), *points, 3, lanes))

    def advance(
        self, part: Part, slopes: StateSlopes, by_contraction: np.ndarray, chosen: np.ndarray
    ) -> None:
        """Bring the derivatives, in place, to the end of a step or a part of one in the lanes chosen [lanes].

        by_contraction: derivatives of the contraction [columns, muscles, lanes]. Raises SimulationError where the
        matrix of every lane is singular; the derivatives of a single such lane are no numbers.
        """
        state, drive, c, lane = part.before, part.drive, part.coefficients, self._lane
        moving = slopes.position, slopes.velocity, slopes.acceleration
        strained, bad = StrainedSystem(self.system, part.motion), np.full(self.system.lanes, -1)
        slope_system.begin(
            self._matrix.at_step(part, strained),
            moving,
            c.to_balance,
            self._moved,
            np.concatenate([self._at_rest, by_contraction], axis=1),
            self._no_stress if slopes.branch is None else self._carried(slopes, c.at),
            self._right,
            bad,
            lane,
        )
        self._matrix.check(bad)
        rate, inertia, instead = self._moved
        laws = self._matrix.laws
        laws.add_directions(rate, inertia, self._right)
        if laws and by_contraction.any():
            laws.add_contraction(strained, drive, by_contraction, self._right)
        for column, parameter in enumerate(self.parameters):
            parameter.add(part.motion, drive, strained, state, c.at, self._right[column])
        slope_system.end(
            self._matrix.matrix, self._right, self._padded, moving, instead, c.to_end, chosen, lane
        )
        if slopes.branch is not None:
            self._advance_branches(part, slopes, chosen)

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
