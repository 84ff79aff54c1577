"""A force effect with its values, bound to a mesh: the forces at its sites, in all lanes at once."""

from collections.abc import Sequence
from copy import copy
from types import SimpleNamespace
from typing import TypeVar

import numpy as np

from hasel_sim.effects.base import ForceEffect, SiteState, Surroundings, normal
from hasel_sim.mechanics.laws import by_group, grouped, one_by_one, repeated, watched
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mesh.sites import Sites

DIFFERENCE = {
    "position": 1e-7,
    "velocity": 1e-7,
    "acceleration": 1e-4,
    "tangent": 1e-6,
    "tangent_rate": 1e-6,
}
"""Of the central differences by each quantity, in its unit."""
_WatchedState = watched(SiteState)
_OF_A_LINE = ("velocity", "acceleration", "tangent", "tangent_rate")
"""What effects at the centre line depend on, in the order in which it is moved for all of them together."""


_Law = TypeVar("_Law", bound="SiteForce")


class SiteForce:
    """One force effect at its sites, of one lane; more by `beside`.

    flux: whether it is the effect's flux that acts (at `mesh.sites.flux_sites`) instead of its force.
    """

    def __init__(
        self,
        effect: ForceEffect,
        values: SimpleNamespace,
        sites: Sites,
        reference: np.ndarray,
        gravity: tuple[float, float] = (0.0, 0.0),
        surroundings: Surroundings | None = None,
        flux: bool = False,
    ) -> None:
        self.effect, self.sites = effect, sites
        self._respond = effect.flux if flux else effect.force
        self._gravity = np.array(gravity)
        self._reference = sites.value(reference[..., None])[..., 0]
        on_skin = effect.sites == "skin"
        self._rest_normal = (
            normal(sites.tangent(reference[..., None])[..., 0]) if on_skin else np.zeros_like(self._reference)
        )
        self._unmoved: dict[int, dict[str, np.ndarray]] = {}
        self._moved_by = tuple(name for name in effect.depends_on if name != "contraction")
        has_tangent = effect.sites in ("skin", "line")
        self._asked = tuple(
            name for name in _OF_A_LINE if name in effect.depends_on or (name == "tangent" and has_tangent)
        )
        self._use_lanes([SimpleNamespace(own=values, surroundings=surroundings)])

    def _use_lanes(self, values: list[SimpleNamespace | None]) -> None:
        self.values, self._groups = values, grouped(values)

    @staticmethod
    def beside(each: Sequence[_Law]) -> list[_Law]:
        """Those of several bodies, one lane after the other: one law for all lanes with the same sites."""
        kinds: list[_Law] = []
        for law in each:
            if not any(law.sites.same_as(kind.sites) for kind in kinds):
                kinds.append(law)
        out = []
        for kind in kinds:
            out.append(copy(kind))
            out[-1]._use_lanes([law.values[0] if law.sites.same_as(kind.sites) else None for law in each])
        return out

    def _moved(self, motion: Motion) -> dict[str, np.ndarray]:
        """Motion at the sites [n, 2, lanes], as far as the effect asks for it."""
        known = motion.found.setdefault(id(self.sites.shape), {})
        return {name: self._field(known, name, motion) for name in ("position", *self._asked)}

    def _field(self, known: dict[str, np.ndarray], name: str, motion: Motion) -> np.ndarray:
        """One quantity at the sites; laws at the same sites share what was interpolated."""
        if name not in known:
            if name in ("tangent", "tangent_rate"):
                known[name] = self.sites.tangent(motion.position if name == "tangent" else motion.velocity)
            else:
                known[name] = self.sites.value(getattr(motion, name))
        return known[name]

    def _force(self, fields: dict[str, np.ndarray], drive: DriveState, values=None) -> np.ndarray:
        """The effect's force at fields [copies, n, 2, lanes], in the same shape; values: others than its own."""
        return by_group(
            self._groups if values is None else grouped(values),
            fields,
            lambda rows, lanes, own: self._called(rows, lanes, own, drive),
        )

    def _repeated(self, times: int) -> dict[str, np.ndarray]:
        """What does not move or is not asked for, as often as the sites are called at once."""
        if times not in self._unmoved:
            self._unmoved[times] = {
                "reference": repeated(self._reference, times),
                "rest_normal": repeated(self._rest_normal, times),
                "measure": repeated(self.sites.measure, times),
                "gravity": self._gravity,
            }
            nothing = np.zeros((times * len(self._reference), 2))
            self._unmoved[times] |= {name: nothing for name in _OF_A_LINE if name not in self._asked}
        return self._unmoved[times]

    def _called(
        self, rows: dict[str, np.ndarray], lanes: np.ndarray, values, drive: DriveState
    ) -> np.ndarray:
        n = len(self._reference)
        unmoved = self._repeated(len(rows["position"]) // n)
        state = (SiteState if len(lanes) == 1 else _WatchedState)(
            **unmoved, **rows, **drive.of_lane(int(lanes[0])), surroundings=values.surroundings
        )
        force = np.asarray(self._respond(state, values.own))
        if len(lanes) == 1 or not state.looked:
            return force
        self._groups = one_by_one(self._groups)
        shape = (-1, len(lanes), n, 2)
        parts = []
        for place, lane in enumerate(lanes):
            own = {name: field.reshape(shape)[:, place].reshape(-1, 2) for name, field in rows.items()}
            parts.append(self._called(own, np.array([lane]), values, drive).reshape(-1, n, 2))
        return np.stack(parts, axis=1)

    def _with_the_others(self, motion: Motion, drive: DriveState, moved: bool) -> np.ndarray | None:
        """The force [copies, n, 2, lanes] at a state that all laws at the centre line share; None where they cannot.

        moved: whether at one copy as it is and two with a little more of each quantity of `_OF_A_LINE`, or as it is.
        """
        lanes, values = self._groups[0] if self._groups else (np.zeros(0), None)
        alike = self.effect.sites == "line" and len(lanes) == motion.position.shape[-1]
        if not alike or values is None or not set(self._moved_by) <= set(_OF_A_LINE):
            return None
        key, n = (id(self.sites.shape), moved, values.surroundings), len(self._reference)
        if key not in motion.found or motion.found[key][0] is not drive:
            motion.found[key] = drive, self._state_of_all(motion, drive, moved, values.surroundings)
        state = motion.found[key][1]
        found = np.asarray(self._respond(state, values.own)).reshape(-1, len(lanes), n, 2)
        if len(lanes) > 1 and state.looked:
            return None
        return np.ascontiguousarray(found.transpose(0, 2, 3, 1))

    def _state_of_all(self, motion: Motion, drive: DriveState, moved: bool, surroundings) -> SiteState:
        """All lanes at the centre line, one copy after the other."""
        known = motion.found.setdefault(id(self.sites.shape), {})
        copies = 1 + 2 * len(_OF_A_LINE) if moved else 1
        rows = {}
        for name in ("position", *_OF_A_LINE):
            field = np.repeat(self._field(known, name, motion)[None], copies, axis=0)
            if moved and name in _OF_A_LINE:
                first = 1 + 2 * _OF_A_LINE.index(name)
                field[first, :, 0] += DIFFERENCE[name]
                field[first + 1, :, 1] += DIFFERENCE[name]
            rows[name] = field.transpose(0, 3, 1, 2).reshape(-1, 2)
        lanes = motion.position.shape[-1]
        unmoved, kind = self._repeated(copies * lanes), SiteState if lanes == 1 else _WatchedState
        return kind(**{**unmoved, **rows}, **drive.of_lane(0), surroundings=surroundings)

    def add_force(
        self, motion: Motion, drive: DriveState, out: np.ndarray, factor: float | np.ndarray = 1.0
    ) -> None:
        """Add factor times the nodal forces to out [nodes, 2, lanes]."""
        force = self._with_the_others(motion, drive, moved=False)
        if force is None:
            force = self._force({name: field[None] for name, field in self._moved(motion).items()}, drive)
        self.sites.scatter(factor * force[0], out)

    def add_excess(
        self,
        other: "SiteForce",
        motion: Motion,
        drive: DriveState,
        out: np.ndarray,
        factor: float | np.ndarray,
    ) -> None:
        """Add factor times the nodal forces that this law has more than another of the same effect and sites."""
        here = {name: field[None] for name, field in self._moved(motion).items()}
        excess = self._force(here, drive) - self._force(here, drive, other.values)
        self.sites.scatter(factor * excess[0], out)

    def respond(
        self,
        motion: Motion,
        drive: DriveState,
        weights: np.ndarray,
        out: np.ndarray,
        by_value: np.ndarray,
        by_tangent: np.ndarray,
    ) -> None:
        """Subtract the nodal forces from out [nodes, 2, lanes], and note how they change, in one call of the effect.

        by_value, by_tangent [n, 2, 2, lanes]: less the derivatives at the sites by the value and by the tangent of the
        end-of-step acceleration, which moves position, velocity and acceleration by weights [3, lanes]; one-sided
        differences, which find a step as well as central ones.
        """
        force, order = self._with_the_others(motion, drive, moved=True), _OF_A_LINE
        if force is None:
            force, order = self._force_of_its_own(motion, drive), self._moved_by
        self.sites.scatter(-force[0], out)
        by_value[:], by_tangent[:] = 0.0, 0.0
        rows = {"position": 0, "velocity": 1, "acceleration": 2, "tangent": 0, "tangent_rate": 1}
        for name in self._moved_by:
            first = 1 + 2 * order.index(name)
            change = (force[first : first + 2] - force[0]) * (-weights[rows[name]] / DIFFERENCE[name])
            table = by_tangent if name.startswith("tangent") else by_value
            table += change.transpose(1, 2, 0, 3)

    def _force_of_its_own(self, motion: Motion, drive: DriveState) -> np.ndarray:
        """The force as it is and with a little more of each component of what it depends on."""
        names, at = self._moved_by, self._moved(motion)
        fields = {name: np.repeat(field[None], 1 + 2 * len(names), axis=0) for name, field in at.items()}
        for index, name in enumerate(names):
            for component in range(2):
                fields[name][1 + 2 * index + component, :, component] += DIFFERENCE[name]
        return self._force(fields, drive)
