"""A force effect with its values, bound to a mesh: the forces at its sites, in all lanes at once."""

from collections.abc import Callable, Sequence
from copy import copy
from functools import partial
from types import SimpleNamespace
from typing import Any, TypeVar

import numpy as np

from hasel_sim.effects.base import ForceEffect, SiteState, Surroundings, guarded, normal
from hasel_sim.mechanics.copies import ALONE, Copies
from hasel_sim.mechanics.laws import (
    OF_THE_DRIVE,
    Groups,
    around,
    by_group,
    by_point,
    grouped,
    on_demand,
    one_by_one,
    repeated,
)
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mechanics.tapes import Answers, Places
from hasel_sim.mesh.sites import Sites
from hasel_sim.tape.law import Law, alike, force_law
from hasel_sim.tape.tracing import NotTraceableError

DIFFERENCE = {
    "position": 1e-7,
    "velocity": 1e-7,
    "acceleration": 1e-4,
    "tangent": 1e-6,
    "tangent_rate": 1e-6,
}
"""Of the central differences by each quantity, in its unit."""
_State = on_demand(SiteState)
_CONTRACTION_DIFFERENCE = 1e-6
NO_MESH = np.zeros((0, 8), dtype=np.intp), np.zeros((0, 0, 8, 2)), np.zeros((0, 0)), np.zeros((0, 0, 1))
_SLOPE_OF = {"tangent": "position", "tangent_rate": "velocity"}
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
        muscles: int = 2,
    ) -> None:
        self.effect, self.sites, self._muscles = effect, sites, muscles
        self._method = "flux" if flux else "force"
        self._respond = partial(guarded, effect, self._method)
        self._gravity = np.array(gravity)
        self._reference = sites.value(reference[..., None])[..., 0]
        on_skin = effect.sites == "skin"
        self._rest_normal = (
            normal(sites.tangent(reference[..., None])[..., 0]) if on_skin else np.zeros_like(self._reference)
        )
        self._unmoved: dict[int, dict[str, np.ndarray]] = {}
        self.k, self.points, self.per = 2, *sites.nodes.shape
        self.numbers, self.reals = sites.nodes, np.stack([sites.shape, sites.slope, sites.weight])
        self.moving = {name: 2 for name in DIFFERENCE if name in effect.depends_on}
        steps = {name: DIFFERENCE[name] for name in self.moving}
        self._moved_once, self._moved_twice = Copies.one_sided(steps, 2), Copies.central(steps, 2)
        has_tangent = effect.sites in ("skin", "line")
        self._asked = {*self.moving, "tangent"} if has_tangent else {*self.moving}
        self._use_lanes([SimpleNamespace(own=values, surroundings=surroundings)])

    @property
    def looks_along(self) -> bool:
        """Whether the force depends on the tangent of the body or on its rate."""
        return any(name.startswith("tangent") for name in self.moving)

    def _use_lanes(self, values: list[SimpleNamespace | None]) -> None:
        self.why_python = ""
        self.values, self._groups = values, grouped(values)
        self.answers = Answers(self, len(values), self._muscles)
        try:
            self.laws: list[Law | None] | None = alike(
                [None if own is None else self._recorded(own.surroundings) for own in values]
            )
        except NotTraceableError as error:
            self.laws, self.why_python = None, str(error)

    def _recorded(self, surroundings: Surroundings | None) -> Law:
        gravity = tuple(self._gravity.tolist())
        return force_law(self.effect, self._method, self._muscles, gravity, surroundings)

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

    def _rows(self, motion: Motion, copies: Copies) -> Callable[[str], np.ndarray]:
        """What moves, by name, in copies of the sites [copies, lanes, n, 2]; zero beyond the position and what this
        effect depends on.
        """
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

    def value(self, motion: Motion, drive: DriveState) -> np.ndarray:
        """The effect's force at the sites, [n, 2, lanes]."""
        return self.answers("value", motion, drive, NO_MESH).transpose(1, 0, 2)

    def add_force(
        self, motion: Motion, drive: DriveState, out: np.ndarray, factor: float | np.ndarray = 1.0
    ) -> None:
        """Add factor times the nodal forces to out [nodes, 2, lanes]."""
        self.sites.scatter(factor * self.value(motion, drive), out)

    def fixed(self, name: str, place: int) -> np.ndarray:
        """What does not move, [n, lanes]."""
        fixed = {
            "reference": self._reference,
            "rest_normal": self._rest_normal,
            "measure": self.sites.measure,
        }
        own = fixed[name].reshape(self.points, -1)[:, [place]]
        return np.broadcast_to(own, (self.points, len(self.values)))

    def fill(
        self, of: Any, motion: Motion, drive: DriveState, mesh: Places, rows: np.ndarray, exact: bool
    ) -> None:
        """Write the rows [rows, n, lanes] of a program, called as Python; central differences where exact, else
        one-sided ones, which find a step as well.
        """
        if isinstance(of, tuple):
            rows[:] = self._change_with(of, motion, drive).transpose(1, 0, 2)
            return
        copies = ALONE if of == "value" else self._moved_twice if exact else self._moved_once
        force = self._force(motion, drive, copies)
        as_it_is = self._force(motion, drive) if copies is self._moved_twice else force
        rows[:2] = by_point(as_it_is[0]).transpose(1, 0, 2)
        if of == "response" and self.moving:
            found = np.zeros((len(self.moving), self.points, 2, 2, len(self.values)))
            for name, slope in zip(self.moving, found, strict=True):
                copies.add_derivative(name, force, np.ones(len(self.values)), slope)
            rows[2:] = found.transpose(0, 3, 2, 1, 4).reshape(rows[2:].shape)

    def _change_with(self, of: tuple, motion: Motion, drive: DriveState) -> np.ndarray:
        """Derivative by a parameter or by a muscle's contraction, [n, 2, lanes]."""
        rows = self._rows(motion, ALONE)
        if of[0] == "contraction":
            step = _CONTRACTION_DIFFERENCE * (np.arange(len(drive.contraction)) == of[1])[:, None]
            drives = [drive.with_contraction(drive.contraction + sign * step) for sign in (1.0, -1.0)]
            more, less = (self._answer(rows, each, 1, self._groups) for each in drives)
            return by_point((more - less)[0]) / (2 * _CONTRACTION_DIFFERENCE)
        values, width = around(self.effect, of[0][1], self.values)
        more, less = (self._answer(rows, drive, 1, grouped(each)) for each in values)
        return by_point((more - less)[0]) / width
