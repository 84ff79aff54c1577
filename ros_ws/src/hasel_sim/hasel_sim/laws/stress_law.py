# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A material effect that adds stress, bound to the Gauss points of its regions."""

from collections.abc import Sequence
from copy import copy
from types import SimpleNamespace
from typing import Any

import numpy as np

from hasel_sim.effects.base import MaterialEffect, MaterialPoints, Surroundings
from hasel_sim.laws.python_calls import (
    Copies,
    on_demand,
)
from hasel_sim.laws.recording import stress_law
from hasel_sim.laws.tapes import BoundLaw, Rows
from hasel_sim.mechanics.constitutive import deformation
from hasel_sim.mechanics.solid import Deformation
from hasel_sim.mechanics.state import DriveState, Motion
from hasel_sim.mesh.mesh import Mesh, Places
from hasel_sim.simd import lane_tuple

_DIFFERENCES = {"deformation": 1e-6, "rate": 1e-4}
_Points = on_demand(MaterialPoints, ("time",))


class StressLaw(BoundLaw):
    """One additional stress at the Gauss points of the elements it concerns, and its derivatives.

    points: Gauss points of an element; fibres: fibre stiffness [Pa] of each muscle behind a 0, [1 + muscles]; shear:
    modulus of every element [Pa]. Of one lane; more by `beside`.
    """

    effect: MaterialEffect
    by_each_muscle = False

    def __init__(
        self,
        effect: MaterialEffect,
        values: SimpleNamespace,
        mesh: Mesh,
        points: int,
        fibres: np.ndarray,
        shear: np.ndarray,
    ) -> None:
        self.elements = np.flatnonzero(np.isin(mesh.region, [int(r) for r in effect.regions]))
        self._muscle = mesh.muscle[self.elements]
        self._element = np.repeat(np.arange(len(self.elements)), points)
        self._muscle_at = self._muscle[self._element]
        places, numbers = (len(self._element), points), np.concatenate([self.elements, self._muscle_at])
        super().__init__(effect, "first_piola", 4, places, _DIFFERENCES, numbers, np.zeros(0))
        own = SimpleNamespace(own=values, surroundings=None)
        self._use_lanes([own], fibres[:, None], shear[self.elements, None])

    def _use_lanes(self, values: list[SimpleNamespace], fibres: np.ndarray, shear: np.ndarray) -> None:
        self._fibres, self._shear = fibres, shear
        self._constant: dict[tuple[int, ...], dict[str, np.ndarray]] = {}
        self._use(values, len(fibres) - 1, lambda _: stress_law(self.effect))

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

    def stress(self, at: Deformation, drive: DriveState) -> np.ndarray:
        """First Piola stress [elements here, points, 4, lanes]."""
        return self._by_element(self.answers("value", at.motion, drive, at.places))

    def _by_element(self, rows: np.ndarray) -> np.ndarray:
        """Four rows [4, n, lanes] as [elements here, points, 4, lanes]."""
        return rows.transpose(1, 0, 2).reshape(len(self.elements), self.per, 4, -1)

    def fixed(self, name: str, place: int) -> np.ndarray:
        """What does not move, [n, lanes]."""
        return self._fibres[self._muscle_at] if name == "fibre" else self._shear[self._element]

    def _respond(self, state: Any, values: SimpleNamespace) -> np.ndarray:
        with np.errstate(invalid="ignore", divide="ignore"):  # inside out: NaN, and the step is refused
            return super()._respond(state, values)

    def _rows(self, motion: Motion, mesh: Places, copies: Copies) -> Rows:
        """F and its rate, by name, in copies of the points here, [copies, lanes, n, 4]."""
        made: dict[str, np.ndarray] = {}
        elements, gradients, areas, stretch = mesh

        def rows(name: str) -> np.ndarray:
            if name not in made:
                field = motion.position if name == "deformation" else motion.velocity
                F = np.empty((*areas.shape, 4, field.shape[-1]))
                lane = lane_tuple(field.shape[-1])
                deformation(np.ascontiguousarray(field), elements, gradients, stretch, F, lane)
                made[name] = copies.rows(name, F[self.elements].reshape(-1, 4, field.shape[-1]))
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
        everyone = self._shear.shape[-1]

        def at_points(of_each: np.ndarray, which: np.ndarray) -> np.ndarray:
            """What each of some has [some, all lanes] at the points, lane by lane, [copies lanes n]."""
            return np.tile(of_each[:, lanes][which].T.ravel(), copies)

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

    def add_moduli(
        self, at: Deformation, drive: DriveState, elastic: np.ndarray, viscous: np.ndarray
    ) -> None:
        """Add the derivatives by F and by its rate to elastic and viscous [elements, points, 4, 4, lanes]."""
        moduli = {"deformation": elastic, "rate": viscous}
        for name, change in self.moduli(at, drive).items():
            moduli[name][self.elements] += change

    def moduli(self, at: Deformation, drive: DriveState) -> dict[str, np.ndarray]:
        """Derivatives by F and by its rate as far as it depends on them, [elements here, points, 4, 4, lanes]."""
        found = self.answers("response", at.motion, drive, at.places)[4:]
        found = found.reshape(-1, 4, 4, *found.shape[1:]).transpose(0, 3, 2, 1, 4)
        shape = len(self.elements), self.per, 4, 4, len(self.values)
        return {name: slope.reshape(shape) for name, slope in zip(self.moving, found, strict=True)}

    def contraction_slopes(self, at: Deformation, drive: DriveState) -> np.ndarray:
        """Derivative of the stress by the contraction of every muscle, [muscles, elements here, points, 4, lanes].

        A point knows the contraction of the muscle it lies in only, so one derivative serves all. Of no muscle where
        the effect is known not to ask for the contraction.
        """
        if self.laws is not None and not self.laws[0].program(("contraction", 0)).outputs:
            return np.empty((0, len(self.elements), *at.F.shape[1:]))
        change = self._by_element(self.answers(("contraction", 0), at.motion, drive, at.places))
        here = self._muscle == np.arange(1, len(self._fibres))[:, None]
        return here[:, :, None, None, None] * change


def places_of_stress(elements: int, laws: Sequence[StressLaw]) -> tuple[np.ndarray, int]:
    """The place of each of so many elements among those that a law concerns, or -1; and how many these are."""
    concerned = np.unique(np.concatenate([np.zeros(0, dtype=np.intp), *(law.elements for law in laws)]))
    place = np.full(elements, -1)
    place[concerned] = np.arange(len(concerned))
    return place, len(concerned)
