"""A force effect with its values, bound to a mesh: the forces at its sites, in all lanes at once."""

from collections.abc import Callable, Sequence
from copy import copy
from types import SimpleNamespace
from typing import Any, TypeVar

import numpy as np

from hasel_sim.effects.base import ForceEffect, SiteState, Surroundings, normal
from hasel_sim.mechanics.copies import ALONE, Copies
from hasel_sim.mechanics.laws import (
    OF_THE_DRIVE,
    Groups,
    by_group,
    by_point,
    grouped,
    on_demand,
    one_by_one,
    repeated,
)
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
_State = on_demand(SiteState)
_SLOPE_OF = {"tangent": "position", "tangent_rate": "velocity"}
_OF_A_LINE = ("velocity", "acceleration", "tangent", "tangent_rate")
"""What effects at the centre line depend on."""
_MOVED_LINE = Copies.one_sided({name: DIFFERENCE[name] for name in _OF_A_LINE}, 2)
"""As it is moved for all of them together."""


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
        steps = {name: DIFFERENCE[name] for name in self._moved_by}
        self._moved_once, self._moved_twice = Copies.one_sided(steps, 2), Copies.central(steps, 2)
        has_tangent = effect.sites in ("skin", "line")
        self._asked = tuple(
            name for name in _OF_A_LINE if name in effect.depends_on or (name == "tangent" and has_tangent)
        )
        self._use_lanes([SimpleNamespace(own=values, surroundings=surroundings)])

    @property
    def looks_along(self) -> bool:
        """Whether the force depends on the tangent of the body or on its rate."""
        return any(name.startswith("tangent") for name in self._moved_by)

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

    def _rows(
        self, motion: Motion, copies: Copies, asked: Sequence[str] | None = None
    ) -> Callable[[str], np.ndarray]:
        """What moves, by name, in copies of the sites [copies, lanes, n, 2]; laws at the same sites share what was
        interpolated. Zero beyond the position and what is asked for, by default what this effect depends on.
        """
        known = motion.found.setdefault(id(self.sites.shape), {})
        made: dict[str, np.ndarray] = {}

        def rows(name: str) -> np.ndarray:
            if name != "position" and name not in (self._asked if asked is None else asked):
                return np.zeros((len(copies), len(self.values), *self._reference.shape))
            if name not in known:
                along, of = name.startswith("tangent"), _SLOPE_OF.get(name, name)
                known[name] = (self.sites.tangent if along else self.sites.value)(getattr(motion, of))
            if name not in made:
                made[name] = copies.rows(name, known[name])
            return made[name]

        return rows

    def _force(self, motion: Motion, drive: DriveState, copies: Copies = ALONE) -> np.ndarray:
        """The effect's force at copies of a state, [copies, lanes, n, 2]."""
        return self._answer(self._rows(motion, copies), drive, len(copies), self._groups)

    def _answer(
        self, rows: Callable[[str], np.ndarray], drive: DriveState, copies: int, groups: Groups
    ) -> np.ndarray:
        """The same from rows and for any groups of lanes with their values."""

        def ask(lanes: np.ndarray, values: SimpleNamespace) -> np.ndarray | None:
            state = self._state(rows, drive, copies, lanes, values.surroundings)
            force = np.asarray(self._respond(state, values.own))
            if len(lanes) == 1 or not state.looked:
                return force
            self._groups = one_by_one(self._groups)
            return None

        return by_group(groups, (copies, len(self.values), *self._reference.shape), ask)

    def _state(
        self,
        rows: Callable[[str], np.ndarray],
        drive: DriveState,
        copies: int,
        lanes: np.ndarray,
        surroundings: Surroundings | None,
    ) -> Any:
        """The sites in some lanes, one lane after the other and one copy after the other."""
        everyone, times = len(lanes) == len(self.values), copies * len(lanes)

        def made(name: str) -> np.ndarray | float:
            if name in OF_THE_DRIVE:
                return drive.of_lane(int(lanes[0]))[name]
            return (rows(name) if everyone else rows(name)[:, lanes]).reshape(-1, 2)

        return _State({**self._repeated(times), "surroundings": surroundings}, made)

    def _repeated(self, times: int) -> dict[str, np.ndarray]:
        """What does not move, as often as the sites are called at once."""
        if times not in self._unmoved:
            self._unmoved[times] = {
                "reference": repeated(self._reference, times),
                "rest_normal": repeated(self._rest_normal, times),
                "measure": repeated(self.sites.measure, times),
                "gravity": self._gravity,
            }
        return self._unmoved[times]

    def _with_the_others(self, motion: Motion, drive: DriveState, moved: bool) -> np.ndarray | None:
        """The force [copies, lanes, n, 2] at a state that all laws at the centre line share; None where they cannot.

        moved: whether at one copy as it is and two with a little more of each quantity of `_OF_A_LINE`, or as it is.
        """
        lanes, values = self._groups[0] if self._groups else (np.zeros(0), None)
        alike = self.effect.sites == "line" and len(lanes) == motion.position.shape[-1]
        if not alike or values is None or not set(self._moved_by) <= set(_OF_A_LINE):
            return None
        copies = _MOVED_LINE if moved else ALONE
        key = id(self.sites.shape), moved, values.surroundings
        if key not in motion.found or motion.found[key][0] is not drive:
            rows = self._rows(motion, copies, _OF_A_LINE)
            state = self._state(rows, drive, len(copies), lanes, values.surroundings)
            motion.found[key] = drive, state
        state = motion.found[key][1]
        force = np.asarray(self._respond(state, values.own))
        if len(lanes) > 1 and state.looked:
            return None
        return np.ascontiguousarray(force, dtype=float).reshape(
            len(copies), len(lanes), *self._reference.shape
        )

    def add_force(
        self, motion: Motion, drive: DriveState, out: np.ndarray, factor: float | np.ndarray = 1.0
    ) -> None:
        """Add factor times the nodal forces to out [nodes, 2, lanes]."""
        force = self._with_the_others(motion, drive, moved=False)
        if force is None:
            force = self._force(motion, drive)
        self.sites.scatter(factor * by_point(force[0]), out)

    def add_excess(
        self,
        other: "SiteForce",
        motion: Motion,
        drive: DriveState,
        out: np.ndarray,
        factor: float | np.ndarray,
    ) -> None:
        """Add factor times the nodal forces that this law has more than another of the same effect and sites."""
        rows = self._rows(motion, ALONE)
        excess = self._answer(rows, drive, 1, self._groups) - self._answer(rows, drive, 1, other._groups)
        self.sites.scatter(factor * by_point(excess[0]), out)

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
        force, copies = self._with_the_others(motion, drive, moved=True), _MOVED_LINE
        if force is None:
            copies = self._moved_once
            force = self._force(motion, drive, copies)
        self.sites.scatter(-by_point(force[0]), out)
        by_value[:], by_tangent[:] = 0.0, 0.0
        rows = {"position": 0, "velocity": 1, "acceleration": 2, "tangent": 0, "tangent_rate": 1}
        for name in self._moved_by:
            table = by_tangent if name.startswith("tangent") else by_value
            copies.add_derivative(name, force, -weights[rows[name]], table)
