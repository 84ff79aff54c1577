"""A force effect with its values, bound to a mesh: forces, their derivatives, and their places in the matrix."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import ForceEffect, SiteState, normal
from hasel_sim.mechanics.compiled import scatter_sites
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mesh.sites import Sites

_CONTRACTION_DIFFERENCE = 1e-6
_DIFFERENCE = {"position": 1e-7, "velocity": 1e-7, "acceleration": 1e-4, "tangent": 1e-6}


class ForceLaw:
    """One force effect at its sites.

    `linearise` differentiates the effect at every site by central differences in the two components of each quantity it
    depends on, all in one call, so that an effect never writes a derivative.
    """

    def __init__(
        self,
        effect: ForceEffect,
        values: SimpleNamespace,
        sites: Sites,
        reference: np.ndarray,
        gravity: tuple[float, float] = (0.0, 0.0),
    ) -> None:
        self.effect, self.values, self.sites = effect, values, sites
        self._gravity = np.array(gravity)
        self._reference = sites.value(reference)
        on_skin = effect.sites == "skin"
        self._rest_normal = normal(sites.tangent(reference)) if on_skin else np.zeros_like(self._reference)
        self._moved_by = tuple(name for name in effect.depends_on if name != "contraction")
        self._copies = 4 * len(self._moved_by)
        self._unmoved = {
            "reference": repeated(self._reference, self._copies),
            "rest_normal": repeated(self._rest_normal, self._copies),
            "measure": repeated(sites.measure, self._copies),
        }
        self._slopes: dict[str, np.ndarray] = {}
        self._by_contraction = np.zeros((0, *self._reference.shape))
        self._last: tuple[Motion, DriveState, SiteState] | None = None

    def state(self, motion: Motion, drive: DriveState) -> SiteState:
        """Motion and drive at the sites; kept for the last motion, which is asked for several times."""
        if self._last is None or self._last[0] is not motion or self._last[1] is not drive:
            self._last = motion, drive, self._state(motion, drive)
        return self._last[2]

    def _state(self, motion: Motion, drive: DriveState) -> SiteState:
        depends = self.effect.depends_on
        nothing = np.zeros_like(self._reference)
        return SiteState(
            position=self.sites.value(motion.position),
            velocity=self.sites.value(motion.velocity) if "velocity" in depends else nothing,
            acceleration=self.sites.value(motion.acceleration) if "acceleration" in depends else nothing,
            tangent=self.sites.tangent(motion.position) if self.effect.sites == "skin" else nothing,
            reference=self._reference,
            rest_normal=self._rest_normal,
            measure=self.sites.measure,
            voltage=drive.voltage,
            contraction=drive.contraction,
            time=drive.time,
            gravity=self._gravity,
        )

    def add_force(self, motion: Motion, drive: DriveState, out: np.ndarray, factor: float = 1.0) -> None:
        """Add factor times the nodal forces to out [nodes, 2]."""
        self.sites.scatter(factor * self.effect.force(self.state(motion, drive), self.values), out)

    def add_excess(
        self, other: "ForceLaw", motion: Motion, drive: DriveState, out: np.ndarray, factor: float
    ) -> None:
        """Add factor times the nodal forces that this law has more than another of the same effect and sites."""
        at = self.state(motion, drive)
        excess = self.effect.force(at, self.values) - self.effect.force(at, other.values)
        self.sites.scatter(factor * excess, out)

    def linearise(self, motion: Motion, drive: DriveState) -> None:
        """Keep the derivatives at this state: one [n, 2, 2] array per quantity the effect depends on."""
        if not self.effect.depends_on:
            return
        state = self.state(motion, drive)
        if "contraction" in self.effect.depends_on:
            self._by_contraction = self._contraction_slope(state)
        if self._moved_by:
            self._differentiate(state)

    def _contraction_slope(self, state: SiteState) -> np.ndarray:
        count = len(state.contraction)
        out = np.empty((count, *self._reference.shape))
        for muscle, step in enumerate(_CONTRACTION_DIFFERENCE * np.eye(count)):
            more, less = (
                self.effect.force(replace(state, contraction=contraction), self.values)
                for contraction in (state.contraction + step, state.contraction - step)
            )
            out[muscle] = (more - less) / (2 * _CONTRACTION_DIFFERENCE)
        return out

    def _differentiate(self, state: SiteState) -> None:
        names = self._moved_by
        n = len(self._reference)
        fields = {name: repeated(getattr(state, name), self._copies) for name in _DIFFERENCE}
        for index, name in enumerate(names):
            for component in range(2):
                start = (4 * index + 2 * component) * n
                fields[name][start : start + n, component] += _DIFFERENCE[name]
                fields[name][start + n : start + 2 * n, component] -= _DIFFERENCE[name]
        batch = SiteState(
            **fields,
            **self._unmoved,
            voltage=state.voltage,
            contraction=state.contraction,
            time=state.time,
            gravity=state.gravity,
        )
        force = self.effect.force(batch, self.values).reshape(len(names), 2, 2, n, 2)
        for index, name in enumerate(names):
            change = (force[index, :, 0] - force[index, :, 1]) / (2 * _DIFFERENCE[name])
            self._slopes[name] = np.ascontiguousarray(change.transpose(1, 2, 0))

    def _slope(self, name: str) -> np.ndarray:
        return self._slopes.get(name, np.zeros((len(self._reference), 2, 2)))

    def add_matrix(
        self, position: float, velocity: float, acceleration: float, band: np.ndarray, diagonal: int
    ) -> None:
        """Subtract the weighted derivatives from a band matrix (the force stands on the right-hand side)."""
        direct = -(
            position * self._slope("position")
            + velocity * self._slope("velocity")
            + acceleration * self._slope("acceleration")
        )
        along = -position * self._slope("tangent")
        s = self.sites
        scatter_sites(direct, along, s.nodes, s.shape, s.slope, s.measure, band, diagonal)

    def add_directions(
        self, shift: np.ndarray, rate: np.ndarray, acceleration: np.ndarray, out: np.ndarray
    ) -> None:
        """Subtract the change of the nodal forces along many directions [columns, nodes, 2] from out."""
        if not self._moved_by:
            return
        moved = {
            "position": lambda: self.sites.value(shift),
            "velocity": lambda: self.sites.value(rate),
            "acceleration": lambda: self.sites.value(acceleration),
            "tangent": lambda: self.sites.tangent(shift),
        }
        for name in self._moved_by:
            slope, change = self._slopes[name], moved[name]()
            self.sites.scatter(-(slope[:, :, 0] * change[..., :1] + slope[:, :, 1] * change[..., 1:]), out)

    def add_pulled_back(self, weights: np.ndarray, out: np.ndarray) -> None:
        """Subtract the transposed derivatives times weights [nodes, 2] from out [3, nodes, 2].

        The first axis of out: by position, velocity and acceleration.
        """
        s = self.sites
        here = s.measure[:, None] * s.value(weights)
        places = {
            "position": (0, s.shape),
            "velocity": (1, s.shape),
            "acceleration": (2, s.shape),
            "tangent": (0, s.slope),
        }
        for name in self._moved_by:
            row, interpolation = places[name]
            pulled = np.einsum("nij,ni->nj", self._slopes[name], here)
            np.subtract.at(out[row], s.nodes, interpolation[:, :, None] * pulled[:, None, :])

    def add_contraction(self, out: np.ndarray) -> None:
        """Subtract the change of the nodal forces by the contraction of each muscle from out [muscles, nodes, 2]."""
        if len(self._by_contraction):
            self.sites.scatter(-self._by_contraction, out)


def repeated(rows: np.ndarray, copies: int) -> np.ndarray:
    """Rows [n, ...] as often as asked, one copy after the other, [copies n, ...]."""
    out = np.empty((copies, *rows.shape), dtype=rows.dtype)
    out[:] = rows
    return out.reshape(-1, *rows.shape[1:])
