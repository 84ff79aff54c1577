"""Mass of the body: consistent (banded) and lumped."""

from collections.abc import Sequence
from copy import copy

import numpy as np

from hasel_sim.mechanics.assembly import mass_product
from hasel_sim.mesh.mesh import Mesh
from hasel_sim.mesh.serendipity import reference_gradients
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
        self.lumped = _lumped(mesh, masses)
        """Mass of every node [kg per m depth], by scaling the diagonal (Hinton, Rock, Zienkiewicz 1976), [nodes]."""

    @staticmethod
    def beside(each: Sequence["Mass"]) -> "Mass":
        """Those of several bodies, one lane after the other."""
        out = copy(each[0])
        out.masses = np.concatenate([mass.masses for mass in each], axis=-1)
        return out

    def product(self, columns: np.ndarray) -> np.ndarray:
        """Mass times each of the vectors [columns, nodes, 2, lanes]; the same shape comes back."""
        out = np.zeros(columns.shape)
        mass_product(
            self.masses, self._elements, np.ascontiguousarray(columns), out, lane_tuple(columns.shape[-1])
        )
        return out


def _lumped(mesh: Mesh, masses: np.ndarray) -> np.ndarray:
    out = np.zeros(len(mesh.nodes))
    diagonal = np.einsum("eaa->ea", masses)
    share = diagonal * (masses.sum(axis=(1, 2)) / diagonal.sum(axis=1))[:, None]
    np.add.at(out, mesh.elements, share)
    return out
