"""A material effect that adds stress, bound to the Gauss points of its regions."""

from collections.abc import Sequence
from copy import copy
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import MaterialEffect, MaterialPoints
from hasel_sim.mechanics.laws import by_group, grouped, one_by_one, repeated, watched
from hasel_sim.mechanics.motion import DriveState
from hasel_sim.mesh.mesh import Mesh

_DIFFERENCE = {"deformation": 1e-6, "rate": 1e-4}
_WatchedPoints = watched(MaterialPoints, ("time",))


class StressLaw:
    """One additional stress at the Gauss points of the elements it concerns; derivatives by central differences.

    fibres: fibre stiffness [Pa] of each muscle behind a 0, [1 + muscles]; shear: modulus of every element [Pa]. Of one
    lane; more by `beside`.
    """

    def __init__(
        self,
        effect: MaterialEffect,
        values: SimpleNamespace,
        mesh: Mesh,
        fibres: np.ndarray,
        shear: np.ndarray,
    ) -> None:
        self.effect = effect
        self.elements = np.flatnonzero(np.isin(mesh.region, [int(r) for r in effect.regions]))
        self._muscle = mesh.muscle[self.elements]
        self._use_lanes([values], fibres[:, None], shear[self.elements, None])

    def _use_lanes(self, values: list[SimpleNamespace], fibres: np.ndarray, shear: np.ndarray) -> None:
        self.values, self._groups, self._fibres, self._shear = values, grouped(values), fibres, shear
        self._constant: dict[tuple[int, ...], tuple[np.ndarray, np.ndarray]] = {}

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

    def stress(self, deformation: np.ndarray, rate: np.ndarray, drive: DriveState) -> np.ndarray:
        """First Piola stress [elements here, points, 4, lanes] for gradients and rates of all elements."""
        here, speed = deformation[self.elements], rate[self.elements]
        flat = (1, -1, 4, here.shape[-1])
        return self._evaluate(here.reshape(flat), speed.reshape(flat), drive, here.shape[1]).reshape(
            here.shape
        )

    def _evaluate(self, F: np.ndarray, rate: np.ndarray, drive: DriveState, points: int) -> np.ndarray:
        """The effect's stress at [copies, n, 4, lanes], in the same shape."""
        fields, element = {"deformation": F, "rate": rate}, np.repeat(np.arange(len(self._muscle)), points)
        return by_group(
            self._groups, fields, lambda rows, lanes, own: self._called(rows, lanes, own, drive, element)
        )

    def _called(self, rows: dict[str, np.ndarray], lanes: np.ndarray, values, drive: DriveState, element):
        times, muscle = len(rows["rate"]) // (len(element) * len(lanes)), self._muscle[element]

        def at_points(of_each: np.ndarray, which: np.ndarray = muscle) -> np.ndarray:
            """What each muscle has [1 + muscles, all lanes] at the points, lane by lane, [copies lanes n]."""
            return repeated(of_each[:, lanes][which].T.ravel(), times)

        key = times, *lanes.tolist()
        if key not in self._constant:
            self._constant[key] = at_points(self._fibres), at_points(self._shear, element)
        constant, none = self._constant[key], np.zeros((1, drive.contraction.shape[-1]))
        at = (MaterialPoints if len(lanes) == 1 else _WatchedPoints)(
            rows["deformation"].reshape(-1, 2, 2),
            rows["rate"].reshape(-1, 2, 2),
            at_points(np.concatenate([none, drive.contraction])),
            at_points(np.concatenate([none, drive.voltage])),
            constant[0],
            float(drive.time[lanes[0]]),
            constant[1],
        )
        with np.errstate(invalid="ignore", divide="ignore"):  # inside out: NaN, and the step is refused
            stress = np.asarray(self.effect.first_piola(at, values)).reshape(-1, 4)
        if len(lanes) == 1 or not at.looked:
            return stress
        self._groups = one_by_one(self._groups)
        shape = (times, len(lanes), len(element), 4)
        parts = []
        for place, lane in enumerate(lanes):
            own = {name: field.reshape(shape)[:, place].reshape(-1, 4) for name, field in rows.items()}
            found = self._called(own, np.array([lane]), values, drive, element)
            parts.append(found.reshape(times, len(element), 4))
        return np.stack(parts, axis=1)

    def add_moduli(
        self,
        deformation: np.ndarray,
        rate: np.ndarray,
        drive: DriveState,
        elastic: np.ndarray,
        viscous: np.ndarray,
    ) -> None:
        """Add the derivatives by F and by its rate to elastic and viscous [elements, points, 4, 4, lanes]."""
        moduli = {"deformation": elastic, "rate": viscous}
        for name, change in self.moduli(deformation, rate, drive).items():
            moduli[name][self.elements] += change

    def moduli(self, deformation: np.ndarray, rate: np.ndarray, drive: DriveState) -> dict[str, np.ndarray]:
        """Derivatives by F and by its rate as far as it depends on them, [elements here, points, 4, 4, lanes]."""
        names = self.effect.depends_on
        fields = {"deformation": deformation[self.elements], "rate": rate[self.elements]}
        shape = fields["deformation"].shape
        n, copies = shape[0] * shape[1], 8 * len(names)
        batch = {
            name: np.repeat(field.reshape(1, n, 4, shape[-1]), copies, axis=0)
            for name, field in fields.items()
        }
        for index, name in enumerate(names):
            for component in range(4):
                first = 8 * index + 2 * component
                batch[name][first, :, component] += _DIFFERENCE[name]
                batch[name][first + 1, :, component] -= _DIFFERENCE[name]
        P = self._evaluate(batch["deformation"], batch["rate"], drive, shape[1])
        P = P.reshape(len(names), 4, 2, *P.shape[1:])
        out = {}
        for index, name in enumerate(names):
            change = (P[index, :, 0] - P[index, :, 1]) / (2 * _DIFFERENCE[name])
            out[name] = change.transpose(1, 2, 0, 3).reshape(*shape[:3], 4, shape[3])
        return out

    def respond(
        self, deformation: np.ndarray, rate: np.ndarray, drive: DriveState, weights: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """First Piola stress [elements here, points, 4, lanes] and how it changes, in one call of the effect.

        The change, [elements here, points, 4, 4, lanes], is by the gradient of the end-of-step acceleration, which
        moves position and velocity by the first two of weights [3, lanes]; one-sided differences, which find a step as
        well as central ones.
        """
        names = self.effect.depends_on
        fields = {"deformation": deformation[self.elements], "rate": rate[self.elements]}
        shape = fields["deformation"].shape
        n, lanes, copies = shape[0] * shape[1], shape[3], 1 + 4 * len(names)
        batch = {
            name: np.repeat(field.reshape(1, n, 4, lanes), copies, axis=0) for name, field in fields.items()
        }
        for index, name in enumerate(names):
            for component in range(4):
                batch[name][1 + 4 * index + component, :, component] += _DIFFERENCE[name]
        P = self._evaluate(batch["deformation"], batch["rate"], drive, shape[1])
        by_motion = np.zeros((n, 4, 4, lanes))
        for index, name in enumerate(names):
            weight = weights[("deformation", "rate").index(name)] / _DIFFERENCE[name]
            change = (P[1 + 4 * index : 5 + 4 * index] - P[0]) * weight
            by_motion += change.transpose(1, 2, 0, 3)
        return P[0].reshape(shape), by_motion.reshape(*shape[:3], 4, lanes)

    def contraction_slopes(self, deformation: np.ndarray, rate: np.ndarray, drive: DriveState) -> np.ndarray:
        """Derivative of the stress by the contraction of every muscle, [muscles, elements here, points, 4, lanes].

        A point knows the contraction of the muscle it lies in only, so one difference serves all.
        """
        more, less = (
            self.stress(deformation, rate, drive.with_contraction(drive.contraction + step))
            for step in (1e-6, -1e-6)
        )
        change = (more - less) / 2e-6
        here = self._muscle == np.arange(1, len(self._fibres))[:, None]
        return here[:, :, None, None, None] * change
