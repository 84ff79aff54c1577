"""The derivatives of a force effect's nodal forces, and their places in the matrix."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from hasel_sim.mechanics.law_terms import SiteGroups, add_site_matrix, site_groups
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mechanics.site_force import NO_MESH, SiteForce
from hasel_sim.simd import lane_tuple


class ForceLaw(SiteForce):
    """A force and, once `linearise` was called, its derivatives at that state.

    `linearise` differentiates the effect at every site by the two components of each quantity it depends on, so that an
    effect never writes a derivative.
    """

    def _use_lanes(self, values: list) -> None:
        super()._use_lanes(values)
        self._slopes: dict[str, np.ndarray] = {}
        self._by_contraction: np.ndarray | None = None

    def linearise(self, motion: Motion, drive: DriveState) -> None:
        """Keep the derivatives at this state: one [n, 2, 2, lanes] array per quantity the effect depends on."""
        if "contraction" in self.effect.depends_on:
            self._by_contraction = self.by_contraction(motion, drive)
        if self.moving:
            self.keep(self.answers("response", motion, drive, NO_MESH))

    def by_contraction(self, motion: Motion, drive: DriveState) -> np.ndarray:
        """Derivative of the force by every muscle's contraction, [muscles, n, 2, lanes]."""
        found = [
            self.answers(("contraction", muscle), motion, drive, NO_MESH).transpose(1, 0, 2)
            for muscle in range(len(drive.contraction))
        ]
        return np.array(found).reshape(-1, *self._reference.shape, len(self.values))

    def keep(self, response: np.ndarray) -> None:
        """Keep derivatives found otherwise: the rows of the effect's response [rows, n, lanes]."""
        found = response[2:].reshape(-1, 2, 2, *response.shape[1:]).transpose(0, 3, 2, 1, 4)
        self._slopes = dict(zip(self.moving, found.copy(), strict=True))

    def weighted(self, position, velocity, acceleration) -> tuple[np.ndarray, np.ndarray]:
        """Less the derivatives, weighted per lane: by the value and by the tangent at the sites [n, 2, 2, lanes]."""
        shares = {"position": position, "velocity": velocity, "acceleration": acceleration}
        nothing = np.zeros((len(self._reference), 2, 2, len(self.values)))
        direct = nothing - sum(shares[name] * slope for name, slope in self._slopes.items() if name in shares)
        shares = {"tangent": position, "tangent_rate": velocity}
        along = nothing - sum(shares[name] * slope for name, slope in self._slopes.items() if name in shares)
        return direct, along

    def add_matrix(self, position, velocity, acceleration, band: np.ndarray, diagonal: int) -> None:
        """Subtract the derivatives, weighted per lane, from a band matrix (the force stands on the right-hand side)."""
        if not self.moving:
            return
        derivatives = self.weighted(position, velocity, acceleration)
        add_site_matrix((self._site_groups, *derivatives), band, diagonal, lane_tuple(band.shape[-1]))

    @cached_property
    def _site_groups(self) -> SiteGroups:
        return site_groups([(self.sites, self.looks_along)])

    def add_directions(
        self, shift: np.ndarray | None, rate: np.ndarray, acceleration: np.ndarray, out: np.ndarray
    ) -> None:
        """Subtract the change of the nodal forces along many directions [columns, nodes, 2, lanes] from out.

        shift: None for no change of the positions.
        """
        sites = self.sites
        moved = {
            "position": (shift, sites.shape),
            "velocity": (rate, sites.shape),
            "acceleration": (acceleration, sites.shape),
            "tangent": (shift, sites.slope),
            "tangent_rate": (rate, sites.slope),
        }
        for name in self.moving:
            field, weights = moved[name]
            if field is not None:
                sites.scatter_products(self._slopes[name], weights, field, out)

    def add_pulled_back(self, weights: np.ndarray, out: Sequence[np.ndarray | None]) -> None:
        """Subtract the transposed derivatives times weights [nodes, 2, lanes] from out, each [nodes, 2, lanes].

        out: by position, velocity and acceleration, None for what is not wanted.
        """
        s = self.sites
        here = s.gathered(weights)
        places = {
            "position": (0, s.shape),
            "velocity": (1, s.shape),
            "acceleration": (2, s.shape),
            "tangent": (0, s.slope),
            "tangent_rate": (1, s.slope),
        }
        for name in self.moving:
            row, interpolation = places[name]
            wanted = out[row]
            if wanted is None:
                continue
            pulled = np.einsum("nijl,nil->njl", self._slopes[name], here)
            np.subtract.at(wanted, s.nodes, interpolation[:, :, None, None] * pulled[:, None])

    def add_contraction(self, out: np.ndarray) -> None:
        """Subtract the change of the nodal forces by each muscle's contraction from out [muscles, nodes, 2, lanes]."""
        if self._by_contraction is not None:
            self.sites.scatter(-self._by_contraction, out)
