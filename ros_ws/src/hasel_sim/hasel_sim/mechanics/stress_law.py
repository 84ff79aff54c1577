"""A material effect that adds stress, bound to the Gauss points of its regions."""

from collections.abc import Callable, Sequence
from copy import copy
from types import SimpleNamespace
from typing import Any

import numpy as np

from hasel_sim.effects.base import MaterialEffect, MaterialPoints, guarded
from hasel_sim.mechanics import strain
from hasel_sim.mechanics.copies import ALONE, Copies
from hasel_sim.mechanics.laws import (
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
from hasel_sim.mechanics.strained import Strained
from hasel_sim.mechanics.tapes import Answers, Places
from hasel_sim.mesh.mesh import Mesh
from hasel_sim.simd import lane_tuple
from hasel_sim.tape.law import Law, stress_law
from hasel_sim.tape.tracing import NotTraceableError

_DIFFERENCE = {"deformation": 1e-6, "rate": 1e-4}
_Points = on_demand(MaterialPoints, ("time",))


class StressLaw:
    """One additional stress at the Gauss points of the elements it concerns, and its derivatives.

    points: Gauss points of an element; fibres: fibre stiffness [Pa] of each muscle behind a 0, [1 + muscles]; shear:
    modulus of every element [Pa]. Of one lane; more by `beside`.
    """

    def __init__(
        self,
        effect: MaterialEffect,
        values: SimpleNamespace,
        mesh: Mesh,
        points: int,
        fibres: np.ndarray,
        shear: np.ndarray,
    ) -> None:
        self.effect = effect
        self.elements = np.flatnonzero(np.isin(mesh.region, [int(r) for r in effect.regions]))
        self._muscle = mesh.muscle[self.elements]
        self._element = np.repeat(np.arange(len(self.elements)), points)
        self._muscle_at = self._muscle[self._element]
        steps = {name: step for name, step in _DIFFERENCE.items() if name in effect.depends_on}
        self._moved_once, self._moved_twice = Copies.one_sided(steps, 4), Copies.central(steps, 4)
        self.k, self.points, self.per, self.moving = 4, len(self._element), points, dict.fromkeys(steps, 4)
        self.numbers, self.reals = np.concatenate([self.elements, self._muscle_at]), np.zeros(0)
        self._use_lanes([SimpleNamespace(own=values)], fibres[:, None], shear[self.elements, None])

    def _use_lanes(self, values: list[SimpleNamespace], fibres: np.ndarray, shear: np.ndarray) -> None:
        self.values, self._fibres, self._shear = values, fibres, shear
        self._groups = grouped([one.own for one in values])
        self._constant: dict[tuple[int, ...], dict[str, np.ndarray]] = {}
        self.why_python = ""
        self.answers = Answers(self, len(values), len(fibres) - 1)
        try:
            self.laws: list[Law | None] | None = [stress_law(self.effect)] * len(values)
        except NotTraceableError as error:
            self.laws, self.why_python = None, str(error)

    @staticmethod
    def beside(each: Sequence["StressLaw"]) -> "StressLaw":
        """Those of several bodies, one lane after the other."""
        out = copy(each[0])
        fibres, shear = (np.hstack([getattr(law, name) for law in each]) for name in ("_fibres", "_shear"))
        out._use_lanes([law.values[0] for law in each], fibres, shear)
        return out

    @property
    def concerns_muscles(self) -> bool:
        """Whether any of the elements lies in a muscle."""
        return bool(self._muscle.any())

    def stress(self, at: Strained, drive: DriveState) -> np.ndarray:
        """First Piola stress [elements here, points, 4, lanes]."""
        return self._by_element(self.answers("value", at.motion, drive, at.places))

    def _by_element(self, rows: np.ndarray) -> np.ndarray:
        """Four rows [4, n, lanes] as [elements here, points, 4, lanes]."""
        return rows.transpose(1, 0, 2).reshape(len(self.elements), self.per, 4, -1)

    def fixed(self, name: str, place: int) -> np.ndarray:
        """What does not move, [n, lanes]."""
        return self._fibres[self._muscle_at] if name == "fibre" else self._shear[self._element]

    def fill(
        self, of: Any, motion: Motion, drive: DriveState, mesh: Places, rows: np.ndarray, exact: bool
    ) -> None:
        """Write the rows [rows, n, lanes] of a program, called as Python; central differences where exact, else
        one-sided ones, which find a step as well.
        """
        if isinstance(of, tuple):
            rows[:] = self._change_with(of, self._rows(motion, mesh), drive).transpose(1, 0, 2)
            return
        copies = ALONE if of == "value" else self._moved_twice if exact else self._moved_once
        P = self._answer(self._rows(motion, mesh, copies), drive, self._groups, len(copies))
        as_it_is = (
            self._answer(self._rows(motion, mesh), drive, self._groups) if copies is self._moved_twice else P
        )
        rows[:4] = by_point(as_it_is[0]).transpose(1, 0, 2)
        if of == "response":
            found = np.zeros((len(self.moving), self.points, 4, 4, len(self.values)))
            for name, slope in zip(self.moving, found, strict=True):
                copies.add_derivative(name, P, np.ones(len(self.values)), slope)
            rows[4:] = found.transpose(0, 3, 2, 1, 4).reshape(rows[4:].shape)

    def _change_with(self, of: tuple, rows: Callable[[str], np.ndarray], drive: DriveState) -> np.ndarray:
        """Derivative by a parameter or by the contraction, [n, 4, lanes]."""
        if of[0] == "contraction":
            drives = [drive.with_contraction(drive.contraction + step) for step in (1e-6, -1e-6)]
            more, less = (self._answer(rows, each, self._groups) for each in drives)
            return by_point((more - less)[0]) / 2e-6
        values, width = around(self.effect, of[0][1], self.values)
        more, less = (self._answer(rows, drive, grouped([one.own for one in each])) for each in values)
        return by_point((more - less)[0]) / width

    def _rows(self, motion: Motion, mesh: Places, copies: Copies = ALONE) -> Callable[[str], np.ndarray]:
        """F and its rate, by name, in copies of the points here, [copies, lanes, n, 4]."""
        made: dict[str, np.ndarray] = {}
        elements, gradients, areas, stretch = mesh

        def rows(name: str) -> np.ndarray:
            if name not in made:
                field = motion.position if name == "deformation" else motion.velocity
                F = np.empty((*areas.shape, 4, field.shape[-1]))
                strain.deformation(
                    np.ascontiguousarray(field), elements, gradients, stretch, F, lane_tuple(field.shape[-1])
                )
                made[name] = copies.rows(name, F[self.elements].reshape(-1, 4, field.shape[-1]))
            return made[name]

        return rows

    def _answer(
        self, rows: Callable[[str], np.ndarray], drive: DriveState, groups: Groups, copies: int = 1
    ) -> np.ndarray:
        """The effect's stress in rows and for any groups of lanes with their values, [copies, lanes, n, 4]."""

        def ask(lanes: np.ndarray, values: SimpleNamespace) -> np.ndarray | None:
            at = self._points(rows, drive, lanes, copies)
            with np.errstate(invalid="ignore", divide="ignore"):  # inside out: NaN, and the step is refused
                stress = np.asarray(guarded(self.effect, "first_piola", at, values)).reshape(-1, 4)
            if len(lanes) == 1 or not at.looked:
                return stress
            self._groups = one_by_one(self._groups)
            return None

        return by_group(groups, (copies, self._shear.shape[-1], len(self._element), 4), ask)

    def _points(
        self, rows: Callable[[str], np.ndarray], drive: DriveState, lanes: np.ndarray, copies: int
    ) -> Any:
        """The points in some lanes, one lane after the other and one copy after the other."""
        everyone = self._shear.shape[-1]

        def at_points(of_each: np.ndarray, which: np.ndarray) -> np.ndarray:
            """What each of some has [some, all lanes] at the points, lane by lane, [copies lanes n]."""
            return repeated(of_each[:, lanes][which].T.ravel(), copies)

        def made(name: str) -> np.ndarray | float:
            if name == "time":
                return float(drive.time[lanes[0]])
            if name in ("contraction", "voltage"):
                none = np.zeros((1, drive.contraction.shape[-1]))
                return at_points(np.concatenate([none, getattr(drive, name)]), self._muscle_at)
            chosen = rows(name) if len(lanes) == everyone else rows(name)[:, lanes]
            return chosen.reshape(-1, 2, 2)

        key = copies, *lanes.tolist()
        if key not in self._constant:
            self._constant[key] = {
                "fibre": at_points(self._fibres, self._muscle_at),
                "shear": at_points(self._shear, self._element),
            }
        return _Points(self._constant[key], made)

    def add_moduli(self, at: Strained, drive: DriveState, elastic: np.ndarray, viscous: np.ndarray) -> None:
        """Add the derivatives by F and by its rate to elastic and viscous [elements, points, 4, 4, lanes]."""
        moduli = {"deformation": elastic, "rate": viscous}
        for name, change in self.moduli(at, drive).items():
            moduli[name][self.elements] += change

    def moduli(self, at: Strained, drive: DriveState) -> dict[str, np.ndarray]:
        """Derivatives by F and by its rate as far as it depends on them, [elements here, points, 4, 4, lanes]."""
        found = self.answers("response", at.motion, drive, at.places)[4:]
        found = found.reshape(-1, 4, 4, *found.shape[1:]).transpose(0, 3, 2, 1, 4)
        shape = len(self.elements), self.per, 4, 4, len(self.values)
        return {name: slope.reshape(shape) for name, slope in zip(self.moving, found, strict=True)}

    def contraction_slopes(self, at: Strained, drive: DriveState) -> np.ndarray:
        """Derivative of the stress by the contraction of every muscle, [muscles, elements here, points, 4, lanes].

        A point knows the contraction of the muscle it lies in only, so one derivative serves all. Of no muscle where
        the effect is known not to ask for the contraction.
        """
        if self.laws is not None and not self.laws[0].program(("contraction", 0)).outputs:
            return np.empty((0, len(self.elements), *at.F.shape[1:]))
        change = self._by_element(self.answers(("contraction", 0), at.motion, drive, at.places))
        here = self._muscle == np.arange(1, len(self._fibres))[:, None]
        return here[:, :, None, None, None] * change
