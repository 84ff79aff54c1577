"""What all effects of a model add to a step, side by side for the compiled loops of `march`."""

import numpy as np

from hasel_sim.mechanics.law_terms import site_groups
from hasel_sim.mechanics.linearisation import StrainedSystem
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mechanics.strained import Strained
from hasel_sim.mechanics.system import System


class LawTable:
    """Forces and additional stresses of every effect, called at one motion, with their derivatives where wanted.

    terms: nodal forces out of balance [nodes, 2, lanes]; the sites of all force effects (their `SiteGroups`,
    derivatives by the value and by the tangent of the end-of-step acceleration [sites, 2, 2, lanes]); the place of
    every element among those with further stress or -1, and their stress [n, points, 4, lanes] and its derivative
    [n, points, 4, 4, lanes]. Empty where no effect acts; one at its null is not among the laws. by_rate: derivative of
    the further stress by the rate of the deformation [n, points, 4, 4, lanes] alone, of `linearise`.
    """

    def __init__(self, system: System) -> None:
        self._system, solid, lanes = system, system.solid, system.lanes
        laws = [(law.sites, law.looks_along) for law in system.forces]
        slopes = np.zeros((2, sum(len(sites.nodes) for sites, _ in laws), 2, 2, lanes))
        concerned = [law.elements for law in system.stresses]
        elements = np.unique(np.concatenate([np.zeros(0, dtype=np.intp), *concerned]))
        further = np.full(len(solid.elements), -1)
        further[elements] = np.arange(len(elements))
        points = solid.areas.shape[1]
        stress, matrix, self.by_rate = (
            np.zeros((len(elements), points, *n, lanes)) for n in ((4,), (4, 4), (4, 4))
        )
        self.terms = (
            np.zeros((*system.nodes.shape, lanes)),
            (site_groups(laws), slopes[0], slopes[1]),
            (further, stress, matrix),
        )

    def __bool__(self) -> bool:
        """Whether there are any effects to call."""
        return bool(self._system.forces or self._system.stresses)

    def call(self, motion: Motion, drive: DriveState, weights: np.ndarray | None) -> None:
        """Call every effect once.

        weights [3, lanes]: of the end-of-step acceleration in position, velocity and acceleration, for the derivatives;
        None leaves those of an earlier call.
        """
        self._call_forces(motion, drive, weights)
        if self._system.stresses:
            self._call_stresses(motion, drive, weights)

    def _call_forces(self, motion: Motion, drive: DriveState, weights: np.ndarray | None) -> None:
        forces, (_, by_value, by_tangent), _ = self.terms
        forces[:] = 0.0
        first = 0
        for law in self._system.forces:
            last = first + len(law.sites.nodes)
            if weights is None:
                law.add_force(motion, drive, forces, -1.0)
            else:
                law.respond(motion, drive, weights, forces, by_value[first:last], by_tangent[first:last])
            first = last

    def _call_stresses(self, motion: Motion, drive: DriveState, weights: np.ndarray | None) -> None:
        _, _, (further, stress, matrix) = self.terms
        solid = self._system.solid
        at = Strained(solid, motion)
        stress[:] = 0.0
        if weights is not None:
            matrix[:] = 0.0
        for law in self._system.stresses:
            places = further[law.elements]
            if weights is None:
                stress[places] += law.stress(at, drive)
                continue
            own, by_motion = law.respond(at, drive, weights)
            stress[places] += own
            matrix[places] += by_motion

    def linearise(self, at: StrainedSystem, drive: DriveState, weights: np.ndarray) -> None:
        """Differentiate every effect as exactly as differences can; terms and weights as in `call`."""
        _, (_, by_value, by_tangent), (further, _, matrix) = self.terms
        first = 0
        for law in self._system.forces:
            last = first + len(law.sites.nodes)
            law.linearise(at.motion, drive)
            by_value[first:last], by_tangent[first:last] = law.weighted(*weights)
            first = last
        if self._system.stresses:
            matrix[:], self.by_rate[:] = 0.0, 0.0
        for stress in self._system.stresses:
            places = further[stress.elements]
            for name, moduli in stress.moduli(at, drive).items():
                matrix[places] += weights[("deformation", "rate").index(name)] * moduli
                if name == "rate":
                    self.by_rate[places] += moduli

    def add_directions(self, rate: np.ndarray, acceleration: np.ndarray, out: np.ndarray) -> None:
        """Add the change of the forces out of balance along velocities and accelerations [columns, nodes, 2, lanes]."""
        for law in self._system.forces:
            law.add_directions(None, rate, acceleration, out)

    def add_pulled_back(self, weights: np.ndarray, rate: np.ndarray, acceleration: np.ndarray) -> None:
        """Add to both [nodes, 2, lanes] the transposed derivatives of the forces out of balance times weights."""
        for law in self._system.forces:
            law.add_pulled_back(weights, (None, rate, acceleration))

    def add_contraction(
        self, at: StrainedSystem, drive: DriveState, by_contraction: np.ndarray, out: np.ndarray
    ) -> None:
        """Add what effects change with the contraction, by_contraction [columns, muscles, lanes], to out."""
        if not self:
            return
        muscles = by_contraction.shape[1]
        change = np.zeros((muscles, *self._system.weight.shape))
        at.add_laws_by_contraction(drive, change)
        if change.any():
            out += np.einsum("cml,mndl->cndl", by_contraction, change)
