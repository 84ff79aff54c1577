"""The solid: constants at the Gauss points, internal force and its derivatives."""

import numpy as np

from hasel_sim.effects.base import Coefficients
from hasel_sim.mechanics import compiled
from hasel_sim.mechanics.branches import Branches, green_stress, kept
from hasel_sim.mesh.mesh import Mesh
from hasel_sim.mesh.serendipity import reference_gradients


def lame_constants(youngs_modulus: float, poissons_ratio: float) -> tuple[float, float]:
    """Shear modulus and Lamé's first parameter [Pa] from Young's modulus [Pa] and Poisson's ratio."""
    shear = youngs_modulus / (2 * (1 + poissons_ratio))
    return shear, 2 * shear * poissons_ratio / (1 - 2 * poissons_ratio)


class Solid:
    """Elastic, viscous and fibre stresses of a mesh with given constants.

    plane_stress: no stress through the depth, instead of no strain. Arrays over Gauss points are
    [elements, quadrature_order**2, ...].
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
        # The stress-free shape is stretched along x: gradients are taken with respect to it, and so are areas.
        self.gradients = np.ascontiguousarray(gradients)
        self.gradients[..., 0] /= material.rest_stretch[..., None]
        self.areas = np.ascontiguousarray(areas * material.rest_stretch)
        lame = material.lame
        if plane_stress:
            lame = 2 * material.shear * lame / (lame + 2 * material.shear)
        self.shear, self.linear_lame = np.ascontiguousarray(material.shear), np.ascontiguousarray(lame)
        self._table = np.zeros((len(mesh.elements), compiled.COEFFICIENTS))
        self._table[:, compiled.SHEAR] = material.equilibrium * material.shear
        self._table[:, compiled.LAME] = material.equilibrium * material.lame
        self._table[:, compiled.VISCOUS_SHEAR] = material.retardation * material.shear
        self._table[:, compiled.VISCOUS_LAME] = material.retardation * lame
        self._table[:, compiled.FIBRE] = np.where(self.muscle > 0, material.fibre, 0.0)
        self._tables: dict[float, np.ndarray] = {}
        self._no_history = np.zeros((*areas.shape, 3))

    def gradient(self, field: np.ndarray) -> np.ndarray:
        """Gradient of a nodal field [nodes, 2] at the Gauss points, [elements, points, 4]."""
        out = np.empty((*self.areas.shape, 4))
        compiled.deformation(field, self.elements, self.gradients, out)
        return out

    def table(self, step: float) -> np.ndarray:
        """Coefficients for the compiled loops when the branches have run for `step` [s] since the last known state.

        A step of 0 means at rest for ever: the branches have relaxed.
        """
        if len(self.branches) == 0 or step == 0.0:
            return self._table
        return kept(self._tables, step, self._table_after)

    def _table_after(self, step: float) -> np.ndarray:
        table, gain = self._table.copy(), self.branches.factors(step)[1].sum()
        table[:, compiled.BRANCH_SHEAR] = gain * self.shear
        table[:, compiled.BRANCH_LAME] = gain * self.linear_lame
        return table

    def green_stress(self, F: np.ndarray) -> np.ndarray:
        """C : E at the Gauss points (xx, yy, xy), [elements, points, 3]."""
        out = np.empty((*self.areas.shape, 3))
        green_stress(F, self.shear, self.linear_lame, out)
        return out

    def stress(self, F, rate, contraction: np.ndarray, history: np.ndarray | None, step: float) -> np.ndarray:
        """First Piola stress; history: `Branches.history` or None; contraction: [muscles]."""
        P = np.empty_like(F)
        compiled.first_piola(
            F,
            rate,
            self.table(step),
            self.muscle,
            np.array([0.0, *contraction]),
            self._no_history if history is None else history,
            self.plane_stress,
            P,
        )
        return P

    def moduli(self, F, rate, contraction, history, step: float) -> tuple[np.ndarray, np.ndarray]:
        """Derivatives of `stress` by F and by its rate, [elements, points, 4, 4]."""
        elastic, viscous = np.empty((*F.shape, 4)), np.empty((*F.shape, 4))
        compiled.moduli(
            F,
            rate,
            self.table(step),
            self.muscle,
            np.array([0.0, *contraction]),
            self._no_history if history is None else history,
            self.plane_stress,
            elastic,
            viscous,
        )
        return elastic, viscous

    def add_force(self, P: np.ndarray, out: np.ndarray) -> None:
        """Add the nodal forces of a stress to out [nodes, 2]."""
        compiled.scatter_stress(P, self.elements, self.gradients, self.areas, out)

    def contraction_force(self, F: np.ndarray) -> np.ndarray:
        """Derivative of the internal force by each muscle's contraction, [muscles, nodes, 2]."""
        out = np.empty((self._muscles, int(self.elements.max()) + 1, 2))
        compiled.contraction_force(
            F, self._table, self.muscle, self.elements, self.gradients, self.areas, out
        )
        return out
