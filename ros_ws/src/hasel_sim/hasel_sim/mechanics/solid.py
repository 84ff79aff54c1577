# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The solid and its mass: constants at the Gauss points, internal force and its derivatives."""

from collections.abc import Sequence
from copy import copy
from functools import cached_property

import numpy as np

from hasel_sim.effects.base import Coefficients
from hasel_sim.mechanics import assembly, constitutive
from hasel_sim.mechanics.branches import Branches, StepLength, green_along
from hasel_sim.mechanics.state import Motion
from hasel_sim.mesh.mesh import Mesh, Places, reference_gradients
from hasel_sim.simd import lane_tuple


def element_masses(mesh: Mesh, nodes: np.ndarray, density: np.ndarray) -> np.ndarray:
    """Consistent mass [kg per m depth] of every element, [elements, 8, 8], with 3 x 3 Gauss points (exact)."""
    values, _, areas = reference_gradients(nodes[mesh.elements], 3)
    return np.einsum("e,eg,ga,gb->eab", density, areas, values, values)


def add_tip_plate(masses: np.ndarray, mesh: Mesh, mass: float, rotary_inertia: float) -> None:
    """Add a plate on the far face to the element masses [elements, 8, 8] in place.

    mass [kg per m depth] on the centre line; rotary_inertia [kg m] about it. The face turns at |d'| / |d|, d being the
    line across it, so J |d'|^2 / (2 h^2) is the energy of turning, whatever the angle; the pieces of the face share it.
    """
    places = {node: (e, a) for e, nodes in enumerate(mesh.elements) for a, node in enumerate(nodes)}
    heights = mesh.nodes[mesh.tip, 1]
    e, a = places[mesh.tip[np.argmin(np.abs(heights))]]
    masses[e, a, a] += mass
    whole = np.ptp(heights)
    for low, middle, high in zip(mesh.tip[:-2:2], mesh.tip[1::2], mesh.tip[2::2], strict=True):
        e = places[middle][0]
        ends = [int(np.flatnonzero(mesh.elements[e] == node)[0]) for node in (low, high)]
        height = mesh.nodes[high, 1] - mesh.nodes[low, 1]
        share = rotary_inertia * (height / whole) / height**2
        masses[np.ix_([e], ends, ends)] += share * np.array([[1.0, -1.0], [-1.0, 1.0]])


class Mass:
    """Consistent mass of a mesh: of its elements [kg per m depth] [elements, 8, 8, lanes], and times vectors.

    masses: of one lane, [elements, 8, 8].
    """

    def __init__(self, mesh: Mesh, masses: np.ndarray) -> None:
        self._elements, self.masses = mesh.elements, np.ascontiguousarray(masses[..., None])
        self.lumped = np.zeros(len(mesh.nodes))
        """Mass of every node [kg per m depth], by scaling the diagonal (Hinton, Rock, Zienkiewicz 1976), [nodes]."""
        diagonal = np.einsum("eaa->ea", masses)
        share = diagonal * (masses.sum(axis=(1, 2)) / diagonal.sum(axis=1))[:, None]
        np.add.at(self.lumped, mesh.elements, share)

    @staticmethod
    def beside(each: Sequence["Mass"]) -> "Mass":
        """Those of several bodies, one lane after the other."""
        out = copy(each[0])
        out.masses = np.concatenate([mass.masses for mass in each], axis=-1)
        return out

    def product(self, columns: np.ndarray) -> np.ndarray:
        """Mass times each of the vectors [columns, nodes, 2, lanes]; the same shape comes back."""
        out = np.zeros(columns.shape)
        lane = lane_tuple(columns.shape[-1])
        assembly.mass_product(self.masses, self._elements, np.ascontiguousarray(columns), out, lane)
        return out


def lame_constants(youngs_modulus: float, poissons_ratio: float) -> tuple[float, float]:
    """Shear modulus and Lamé's first parameter [Pa] from Young's modulus [Pa] and Poisson's ratio."""
    shear = youngs_modulus / (2 * (1 + poissons_ratio))
    return shear, 2 * shear * poissons_ratio / (1 - 2 * poissons_ratio)


class Solid:
    """Elastic, viscous and fibre stresses of a mesh with given constants, of one lane; more by `beside`.

    plane_stress: no stress through the depth, instead of no strain. Arrays over Gauss points are
    [elements, quadrature_order**2, ..., lanes].
    """

    def __init__(
        self,
        mesh: Mesh,
        nodes: np.ndarray,
        material: Coefficients,
        branches: Branches,
        plane_stress: bool,
        quadrature_order: int,
    ) -> None:
        self.elements, self.plane_stress, self.branches = mesh.elements, plane_stress, branches
        self.muscle, self._muscles = mesh.muscle, int(mesh.muscle.max(initial=0))
        _, gradients, areas = reference_gradients(nodes[mesh.elements], quadrature_order)
        self._nodes = len(nodes)
        self.gradients, self.areas = np.ascontiguousarray(gradients), np.ascontiguousarray(areas)
        self.stretch = np.array(np.broadcast_to(material.rest_stretch, areas.shape)[..., None], order="C")
        lame = material.lame
        if plane_stress:
            lame = 2 * material.shear * lame / (lame + 2 * material.shear)
        self.shear, self.linear_lame = material.shear[:, None].copy(), lame[:, None].copy()
        self._table = np.zeros((len(mesh.elements), constitutive.COEFFICIENTS, 1))
        self._table[:, constitutive.SHEAR, 0] = material.equilibrium * material.shear
        self._table[:, constitutive.LAME, 0] = material.equilibrium * material.lame
        self._table[:, constitutive.VISCOUS_SHEAR, 0] = material.retardation * material.shear
        self._table[:, constitutive.VISCOUS_LAME, 0] = material.retardation * lame
        self._table[:, constitutive.FIBRE, 0] = np.where(self.muscle > 0, material.fibre, 0.0)
        self._use_lanes()

    def _use_lanes(self) -> None:
        lanes = self._table.shape[-1]
        self._lane, self._shape = lane_tuple(lanes), (*self.areas.shape, 4, lanes)
        self._last_table: tuple[np.ndarray, np.ndarray] | None = None
        self.no_history = np.zeros((*self.areas.shape, 3, lanes))
        self.kept_moduli = np.empty((2, *self.areas.shape, 4, 4, lanes))

    @staticmethod
    def beside(each: Sequence["Solid"]) -> "Solid":
        """Those of several bodies with one mesh, one lane after the other."""
        out = copy(each[0])
        for name in ("stretch", "shear", "linear_lame", "_table"):
            setattr(out, name, np.concatenate([getattr(solid, name) for solid in each], axis=-1))
        out.branches = Branches.beside([solid.branches for solid in each])
        out._use_lanes()
        return out

    def same_shape(self, other: "Solid") -> bool:
        """Whether another one has the same stress-free shape."""
        return np.array_equal(self.gradients, other.gradients) and np.array_equal(self.stretch, other.stretch)

    @property
    def places(self) -> Places:
        """What the compiled loops know of the mesh: elements, gradients, areas and stretch of the stress-free shape."""
        return self.elements, self.gradients, self.areas, self.stretch

    def gradient(self, field: np.ndarray) -> np.ndarray:
        """Gradient of a nodal field [nodes, 2, lanes] at the Gauss points, [elements, points, 4, lanes]."""
        if field.shape != (self._nodes, 2, self._shape[-1]):
            raise ValueError(
                f"a field has the shape {field.shape}; expected {(self._nodes, 2, self._shape[-1])}"
            )
        out = np.empty(self._shape)
        constitutive.deformation(
            np.ascontiguousarray(field), self.elements, self.gradients, self.stretch, out, self._lane
        )
        return out

    def table(self, step: StepLength) -> np.ndarray:
        """Coefficients for the compiled loops when the branches have run for `step` [s] since the last known state.

        A step of 0 means at rest for ever: the branches have relaxed.
        """
        if len(self.branches) == 0 or not np.any(step):
            return self._table
        gain = self.branches.factors(step)[1].sum(axis=0)
        if self._last_table is None or not np.array_equal(self._last_table[0], gain):
            table = self._table.copy()
            table[:, constitutive.BRANCH_SHEAR] = gain * self.shear
            table[:, constitutive.BRANCH_LAME] = gain * self.linear_lame
            self._last_table = gain, table
        return self._last_table[1]

    def green_stress(self, F: np.ndarray) -> np.ndarray:
        """C : E at the Gauss points (xx, yy, xy), [elements, points, 3, lanes]."""
        out = np.empty((*self.areas.shape, 3, F.shape[-1]))
        constitutive.green_stress(F, self.shear, self.linear_lame, out, self._lane)
        return out

    def green_stress_along(self, F: np.ndarray, moved: np.ndarray) -> np.ndarray:
        """Changes of C : E along those of the positions [columns, nodes, 2, lanes], one column after the other."""
        out = np.empty((len(moved), *self.areas.shape, 3, F.shape[-1]))
        law = self.places, self.shear, self.linear_lame
        green_along(np.ascontiguousarray(moved), F, *law, out, self._lane)
        return out

    def _at(
        self,
        F: np.ndarray,
        rate: np.ndarray,
        contraction: np.ndarray,
        history: np.ndarray | None,
        step: StepLength,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, bool]:
        rest = np.zeros((1, contraction.shape[-1]))
        return (
            F,
            rate,
            self.table(step),
            self.muscle,
            np.concatenate([rest, contraction]),
            self.no_history if history is None else history,
            self.plane_stress,
        )

    def stress(
        self,
        F: np.ndarray,
        rate: np.ndarray,
        contraction: np.ndarray,
        history: np.ndarray | None,
        step: StepLength,
    ) -> np.ndarray:
        """First Piola stress; history: `Branches.history` or None; contraction: [muscles, lanes]."""
        P = np.empty_like(F)
        constitutive.first_piola(*self._at(F, rate, contraction, history, step), P, self._lane)
        return P

    def moduli(
        self,
        F: np.ndarray,
        rate: np.ndarray,
        contraction: np.ndarray,
        history: np.ndarray | None,
        step: StepLength,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of `stress` by F and by its rate, [elements, points, 4, 4, lanes]; valid until the next call."""
        elastic, viscous = self.kept_moduli
        constitutive.moduli(*self._at(F, rate, contraction, history, step), elastic, viscous, self._lane)
        return elastic, viscous

    def add_force(self, P: np.ndarray, out: np.ndarray) -> None:
        """Add the nodal forces of a stress to out [nodes, 2, lanes]."""
        assembly.scatter_stress(P, *self.places, out, self._lane)

    def contraction_force(self, F: np.ndarray) -> np.ndarray:
        """Derivative of the internal force by each muscle's contraction, [muscles, nodes, 2, lanes]."""
        out = np.empty((self._muscles, self._nodes, 2, F.shape[-1]))
        mesh = self.elements, self.gradients, self.areas
        assembly.contraction_force(F, self._table, self.muscle, *mesh, out, self._lane)
        return out


class Deformation:
    """A `Solid` at one motion; arrays are [elements, points, 4, lanes]."""

    def __init__(self, solid: Solid, motion: Motion) -> None:
        self.solid, self.motion = solid, motion

    @property
    def places(self) -> Places:
        """What the compiled loops know of the mesh."""
        return self.solid.places

    @cached_property
    def F(self) -> np.ndarray:
        """Deformation gradient [1]."""
        return self.solid.gradient(self.motion.position)

    @cached_property
    def rate(self) -> np.ndarray:
        """Its rate [1/s]."""
        return self.solid.gradient(self.motion.velocity)
