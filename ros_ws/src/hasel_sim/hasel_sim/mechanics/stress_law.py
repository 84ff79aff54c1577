"""A material effect that adds stress, bound to the Gauss points of its regions."""

from collections.abc import Callable, Sequence
from copy import copy
from types import SimpleNamespace
from typing import Any

import numpy as np

from hasel_sim.effects.base import MaterialEffect, MaterialPoints
from hasel_sim.mechanics.copies import ALONE, Copies
from hasel_sim.mechanics.laws import Groups, by_group, by_point, grouped, on_demand, one_by_one, repeated
from hasel_sim.mechanics.motion import DriveState
from hasel_sim.mechanics.strained import Strained
from hasel_sim.mesh.mesh import Mesh

_DIFFERENCE = {"deformation": 1e-6, "rate": 1e-4}
_Points = on_demand(MaterialPoints, ("time",))


class StressLaw:
    """One additional stress at the Gauss points of the elements it concerns; derivatives by central differences.

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
        steps = {name: _DIFFERENCE[name] for name in effect.depends_on}
        self._moved_once, self._moved_twice = Copies.one_sided(steps, 4), Copies.central(steps, 4)
        self._use_lanes([values], fibres[:, None], shear[self.elements, None])

    def _use_lanes(self, values: list[SimpleNamespace], fibres: np.ndarray, shear: np.ndarray) -> None:
        self.values, self._groups, self._fibres, self._shear = values, grouped(values), fibres, shear
        self._constant: dict[tuple[int, ...], dict[str, np.ndarray]] = {}
        self._last: tuple[Strained | None, bool] = None, True

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
        return self._at_points(self._answer(self._rows(at), drive, self._groups), at)

    def excess(self, other: "StressLaw", at: Strained, drive: DriveState) -> np.ndarray:
        """What of it this law has more than another of the same effect and points."""
        rows = self._rows(at)
        more, less = (self._answer(rows, drive, law._groups) for law in (self, other))
        return self._at_points(more - less, at)

    def _at_points(self, found: np.ndarray, at: Strained) -> np.ndarray:
        return by_point(found[0]).reshape(len(self.elements), *at.F.shape[1:])

    def _rows(self, at: Strained, copies: Copies = ALONE) -> Callable[[str], np.ndarray]:
        """F and its rate, by name, in copies of the points here, [copies, lanes, n, 4]."""
        made: dict[str, np.ndarray] = {}

        def rows(name: str) -> np.ndarray:
            if name not in made:
                field = (at.F if name == "deformation" else at.rate)[self.elements]
                made[name] = copies.rows(name, field.reshape(-1, 4, field.shape[-1]))
            return made[name]

        return rows

    def _answer(
        self, rows: Callable[[str], np.ndarray], drive: DriveState, groups: Groups, copies: int = 1
    ) -> np.ndarray:
        """The effect's stress in rows and for any groups of lanes with their values, [copies, lanes, n, 4]."""

        def ask(lanes: np.ndarray, values: SimpleNamespace) -> np.ndarray | None:
            at = self._points(rows, drive, lanes, copies)
            with np.errstate(invalid="ignore", divide="ignore"):  # inside out: NaN, and the step is refused
                stress = np.asarray(self.effect.first_piola(at, values)).reshape(-1, 4)
            self._last = None, at.asked_for(("contraction",))
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
        copies, shape = self._moved_twice, self._shape_of_moduli(at)
        P = self._answer(self._rows(at, copies), drive, self._groups, len(copies))
        self._last = at, self._last[1]
        out = {}
        for name in self.effect.depends_on:
            out[name] = np.zeros(shape)
            copies.add_derivative(name, P, np.ones(shape[-1]), out[name].reshape(-1, *shape[2:]))
        return out

    def respond(self, at: Strained, drive: DriveState, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """First Piola stress [elements here, points, 4, lanes] and how it changes, in one call of the effect.

        The change, [elements here, points, 4, 4, lanes], is by the gradient of the end-of-step acceleration, which
        moves position and velocity by the first two of weights [3, lanes]; one-sided differences, which find a step as
        well as central ones.
        """
        copies, shape = self._moved_once, self._shape_of_moduli(at)
        P = self._answer(self._rows(at, copies), drive, self._groups, len(copies))
        by_motion = np.zeros(shape)
        for name in self.effect.depends_on:
            weight = weights[("deformation", "rate").index(name)]
            copies.add_derivative(name, P, weight, by_motion.reshape(-1, *shape[2:]))
        return self._at_points(P, at), by_motion

    def _shape_of_moduli(self, at: Strained) -> tuple[int, ...]:
        return len(self.elements), at.F.shape[1], 4, 4, at.F.shape[-1]

    def contraction_slopes(self, at: Strained, drive: DriveState) -> np.ndarray:
        """Derivative of the stress by the contraction of every muscle, [muscles, elements here, points, 4, lanes].

        A point knows the contraction of the muscle it lies in only, so one difference serves all. Of no muscle where
        the effect, when its moduli were found here, did not ask for the contraction.
        """
        if self._last[0] is at and not self._last[1]:
            return np.empty((0, len(self.elements), *at.F.shape[1:]))
        more, less = (
            self.stress(at, drive.with_contraction(drive.contraction + step)) for step in (1e-6, -1e-6)
        )
        change = (more - less) / 2e-6
        here = self._muscle == np.arange(1, len(self._fibres))[:, None]
        return here[:, :, None, None, None] * change
