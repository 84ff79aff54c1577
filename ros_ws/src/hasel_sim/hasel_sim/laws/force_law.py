# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A force effect with its values, bound to a mesh: forces at its sites and their derivatives, in all lanes at once."""

from collections.abc import Sequence
from copy import copy
from functools import cached_property
from types import SimpleNamespace
from typing import Any

import numpy as np

from hasel_sim.effects.base import ForceEffect, SiteState, Surroundings, normal
from hasel_sim.laws.python_calls import OF_THE_DRIVE, Copies, on_demand
from hasel_sim.laws.recording import force_law
from hasel_sim.laws.tapes import BoundLaw, Rows
from hasel_sim.mechanics.assembly import SiteGroups, add_site_matrix, site_groups
from hasel_sim.mechanics.state import DriveState, Motion
from hasel_sim.mesh.mesh import Places
from hasel_sim.mesh.sites import Sites
from hasel_sim.simd import lane_tuple

_DIFFERENCES = {
    "position": 1e-7,
    "velocity": 1e-7,
    "acceleration": 1e-4,
    "tangent": 1e-6,
    "tangent_rate": 1e-6,
}
"""Steps by each quantity, in its unit."""
_ROW = {"position": 0, "velocity": 1, "acceleration": 2, "tangent": 0, "tangent_rate": 1}
"""Which of position, velocity and acceleration moves it."""
Weight = float | np.ndarray
"""The same for all lanes, or one each [lanes]."""
_State = on_demand(SiteState)
NO_MESH = np.zeros((0, 8), dtype=np.intp), np.zeros((0, 0, 8, 2)), np.zeros((0, 0)), np.zeros((0, 0, 1))
_SLOPE_OF = {"tangent": "position", "tangent_rate": "velocity"}


class ForceLaw(BoundLaw):
    """One force effect at its sites and, once `linearise` was called, its derivatives at that state.

    Of one lane; more by `beside`. flux: whether it is the effect's flux that acts (at `mesh.sites.flux_sites`) instead
    of its force. `linearise` differentiates the effect at every site by the two components of each quantity it depends
    on, so that an effect never writes a derivative.
    """

    effect: ForceEffect

    def __init__(
        self,
        effect: ForceEffect,
        values: SimpleNamespace,
        sites: Sites,
        reference: np.ndarray,
        gravity: tuple[float, float] = (0.0, 0.0),
        surroundings: Surroundings | None = None,
        flux: bool = False,
        muscles: int = 2,
    ) -> None:
        reals = np.stack([sites.shape, sites.slope, sites.weight])
        method = "flux" if flux else "force"
        super().__init__(effect, method, 2, sites.nodes.shape, _DIFFERENCES, sites.nodes, reals)
        self.sites, self._muscles, self._gravity = sites, muscles, np.array(gravity)
        self._reference = sites.value(reference[..., None])[..., 0]
        self._rest_normal = np.zeros_like(self._reference)
        if effect.sites == "skin":
            self._rest_normal = normal(sites.tangent(reference[..., None])[..., 0])
        self._unmoved: dict[int, dict[str, np.ndarray]] = {}
        self._asked = {*self.moving, "tangent"} if effect.sites in ("skin", "line") else {*self.moving}
        self._use_lanes([SimpleNamespace(own=values, surroundings=surroundings)])

    @property
    def looks_along(self) -> bool:
        """Whether the force depends on the tangent of the body or on its rate."""
        return any(name.startswith("tangent") for name in self.moving)

    def _use_lanes(self, values: list[SimpleNamespace | None]) -> None:
        gravity = tuple(self._gravity.tolist())
        self._slopes: dict[str, np.ndarray] = {}
        self._by_contraction: np.ndarray | None = None
        fixed = self.effect, self._method, self._muscles, gravity
        self._use(values, self._muscles, lambda own: force_law(*fixed, own.surroundings))

    @staticmethod
    def beside(each: Sequence["ForceLaw"]) -> list["ForceLaw"]:
        """Those of several bodies, one lane after the other: one law for all lanes with the same sites."""
        kinds: list[ForceLaw] = []
        for law in each:
            if not any(law.sites.same_as(kind.sites) for kind in kinds):
                kinds.append(law)
        out = [copy(kind) for kind in kinds]
        for kind in out:
            kind._use_lanes([law.values[0] if law.sites.same_as(kind.sites) else None for law in each])
        return out

    def _rows(self, motion: Motion, mesh: Places, copies: Copies) -> Rows:
        """What moves in copies of the sites; zero beyond the position and what this effect depends on."""
        made: dict[str, np.ndarray] = {}

        def rows(name: str) -> np.ndarray:
            if name != "position" and name not in self._asked:
                return np.zeros((len(copies), len(self.values), *self._reference.shape))
            if name not in made:
                along, of = name.startswith("tangent"), _SLOPE_OF.get(name, name)
                field = (self.sites.tangent if along else self.sites.value)(getattr(motion, of))
                made[name] = copies.rows(name, field)
            return made[name]

        return rows

    def _state(
        self,
        rows: Rows,
        drive: DriveState,
        copies: int,
        lanes: np.ndarray,
        surroundings: Surroundings | None,
    ) -> Any:
        everyone, times = len(lanes) == len(self.values), copies * len(lanes)
        if times not in self._unmoved:
            self._unmoved[times] = {
                name: np.tile(own, (times, 1)[: own.ndim]) for name, own in self._fixed.items()
            }
            self._unmoved[times]["gravity"] = self._gravity

        def made(name: str) -> np.ndarray | float:
            if name in OF_THE_DRIVE:
                return drive.of_lane(int(lanes[0]))[name]
            return (rows(name) if everyone else rows(name)[:, lanes]).reshape(-1, 2)

        return _State({**self._unmoved[times], "surroundings": surroundings}, made)

    @property
    def _fixed(self) -> dict[str, np.ndarray]:
        """What does not move, of every site."""
        rest = self._reference, self._rest_normal, self.sites.measure
        return dict(zip(("reference", "rest_normal", "measure"), rest, strict=True))

    def fixed(self, name: str, place: int) -> np.ndarray:
        """What does not move, [n, lanes]."""
        own = self._fixed[name].reshape(self.points, -1)[:, [place]]
        return np.broadcast_to(own, (self.points, len(self.values)))

    def value(self, motion: Motion, drive: DriveState) -> np.ndarray:
        """The effect's force at the sites, [n, 2, lanes]."""
        return self.answers("value", motion, drive, NO_MESH).transpose(1, 0, 2)

    def add_force(self, motion: Motion, drive: DriveState, out: np.ndarray, factor: float = 1.0) -> None:
        """Add factor times the nodal forces to out [nodes, 2, lanes]."""
        self.sites.scatter(factor * self.value(motion, drive), out)

    def linearise(self, motion: Motion, drive: DriveState) -> None:
        """Keep the derivatives at this state: one [n, 2, 2, lanes] array per quantity the effect depends on."""
        if "contraction" in self.effect.depends_on:
            muscles = range(len(drive.contraction))
            found = [self.answers(("contraction", muscle), motion, drive, NO_MESH) for muscle in muscles]
            self._by_contraction = (
                np.array(found).reshape(-1, 2, self.points, len(self.values)).transpose(0, 2, 1, 3)
            )
        if self.moving:
            self.keep(self.answers("response", motion, drive, NO_MESH))

    def keep(self, response: np.ndarray) -> None:
        """Keep derivatives found otherwise: the rows of the effect's response [rows, n, lanes]."""
        found = response[2:].reshape(-1, 2, 2, *response.shape[1:]).transpose(0, 3, 2, 1, 4)
        self._slopes = dict(zip(self.moving, found.copy(), strict=True))

    def weighted(
        self, position: Weight, velocity: Weight, acceleration: Weight
    ) -> tuple[np.ndarray, np.ndarray]:
        """Less the derivatives, weighted per lane: by the value and by the tangent at the sites [n, 2, 2, lanes]."""
        shares = {"position": position, "velocity": velocity, "acceleration": acceleration}
        nothing = np.zeros((len(self._reference), 2, 2, len(self.values)))
        direct = nothing - sum(shares[name] * slope for name, slope in self._slopes.items() if name in shares)
        shares = {"tangent": position, "tangent_rate": velocity}
        along = nothing - sum(shares[name] * slope for name, slope in self._slopes.items() if name in shares)
        return direct, along

    def add_matrix(
        self, position: Weight, velocity: Weight, acceleration: Weight, band: np.ndarray, diagonal: int
    ) -> None:
        """Subtract the derivatives, weighted per lane, from a band matrix (the force stands on the right-hand side)."""
        if not self.moving:
            return
        derivatives = self.weighted(position, velocity, acceleration)
        add_site_matrix((self._site_groups, *derivatives), band, diagonal, lane_tuple(band.shape[-1]))

    @cached_property
    def _site_groups(self) -> SiteGroups:
        return site_groups([(self.sites, self.looks_along)])

    def add_directions(
        self, shift: np.ndarray, rate: np.ndarray, acceleration: np.ndarray, out: np.ndarray
    ) -> None:
        """Subtract the change of the nodal forces along many directions [columns, nodes, 2, lanes] from out."""
        for name in self.moving:
            field = (shift, rate, acceleration)[_ROW[name]]
            self.sites.scatter_products(self._slopes[name], self._interpolation(name), field, out)

    def _interpolation(self, name: str) -> np.ndarray:
        """What gives a quantity at the sites, [n, k]."""
        return self.sites.slope if name.startswith("tangent") else self.sites.shape

    def add_pulled_back(self, weights: np.ndarray, out: Sequence[np.ndarray | None]) -> None:
        """Subtract the transposed derivatives times weights [nodes, 2, lanes] from out, each [nodes, 2, lanes].

        out: by position, velocity and acceleration, None for what is not wanted.
        """
        here = self.sites.gathered(weights)
        for name in self.moving:
            wanted = out[_ROW[name]]
            if wanted is not None:
                pulled = np.einsum("nijl,nil->njl", self._slopes[name], here)
                spread = self._interpolation(name)[:, :, None, None] * pulled[:, None]
                np.subtract.at(wanted, self.sites.nodes, spread)

    def add_contraction(self, out: np.ndarray) -> None:
        """Subtract the change of the nodal forces by each muscle's contraction from out [muscles, nodes, 2, lanes]."""
        if self._by_contraction is not None:
            self.sites.scatter(-self._by_contraction, out)
