"""Mass of the body: consistent (banded) and lumped."""

import numpy as np

from hasel_sim.mechanics.compiled import mass_product
from hasel_sim.mesh.mesh import Mesh
from hasel_sim.mesh.serendipity import reference_gradients


def element_masses(mesh: Mesh, nodes: np.ndarray, density: np.ndarray) -> np.ndarray:
    """Consistent mass [kg per m depth] of every element, [elements, 8, 8], with 3 x 3 Gauss points (exact)."""
    values, _, areas = reference_gradients(nodes[mesh.elements], 3)
    return np.einsum("e,eg,ga,gb->eab", density, areas, values, values)


class Mass:
    """Consistent mass of a mesh: of its elements [kg per m depth] [elements, 8, 8] and as a product with vectors."""

    def __init__(self, mesh: Mesh, masses: np.ndarray) -> None:
        self._elements, self.masses = mesh.elements, np.ascontiguousarray(masses)
        self.lumped = _lumped(mesh, masses)
        """Mass of every node [kg per m depth], by scaling the diagonal (Hinton, Rock, Zienkiewicz 1976), [nodes]."""

    def product(self, columns: np.ndarray) -> np.ndarray:
        """Mass times each of the vectors [columns, nodes, 2]; the same shape comes back."""
        out = np.zeros(columns.shape)
        mass_product(self.masses, self._elements, columns, out)
        return out


def _lumped(mesh: Mesh, masses: np.ndarray) -> np.ndarray:
    out = np.zeros(len(mesh.nodes))
    diagonal = np.einsum("eaa->ea", masses)
    share = diagonal * (masses.sum(axis=(1, 2)) / diagonal.sum(axis=1))[:, None]
    np.add.at(out, mesh.elements, share)
    return out
