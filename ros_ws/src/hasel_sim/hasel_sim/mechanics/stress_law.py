"""A material effect that adds stress, bound to the Gauss points of its regions."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import MaterialEffect, MaterialPoints
from hasel_sim.mechanics.force_law import repeated
from hasel_sim.mesh.mesh import Mesh

_DIFFERENCE = {"deformation": 1e-6, "rate": 1e-4}


class StressLaw:
    """One additional stress at the Gauss points of the elements it concerns; derivatives by central differences.

    fibres: fibre stiffness [Pa] of each muscle behind a 0, [1 + muscles]; shear: modulus of every element [Pa].
    """

    def __init__(
        self,
        effect: MaterialEffect,
        values: SimpleNamespace,
        mesh: Mesh,
        fibres: np.ndarray,
        shear: np.ndarray,
    ) -> None:
        self.effect, self.values = effect, values
        self.elements = np.flatnonzero(np.isin(mesh.region, [int(r) for r in effect.regions]))
        self._muscle, self._shear, self._fibres = mesh.muscle[self.elements], shear[self.elements], fibres
        self._places: dict[tuple[int, int], tuple[np.ndarray, np.ndarray]] = {}

    @property
    def concerns_muscles(self) -> bool:
        """Whether any of the elements lies in a muscle."""
        return bool(self._muscle.any())

    def stress(self, deformation: np.ndarray, rate: np.ndarray, drive) -> np.ndarray:
        """First Piola stress at [elements here, points, 4] for gradients and rates of all elements [.., points, 4]."""
        here, speed = deformation[self.elements], rate[self.elements]
        return self._evaluate(
            here.reshape(-1, 2, 2), speed.reshape(-1, 2, 2), drive, here.shape[1], 1
        ).reshape(here.shape)

    def _evaluate(self, F: np.ndarray, rate: np.ndarray, drive, points: int, copies: int) -> np.ndarray:
        if (points, copies) not in self._places:
            muscle, shear = (
                repeated(np.repeat(here, points), copies) for here in (self._muscle, self._shear)
            )
            self._places[points, copies] = muscle, shear
        muscle, shear = self._places[points, copies]
        contraction, voltage = (
            np.concatenate([[0.0], of_both])[muscle] for of_both in (drive.contraction, drive.voltage)
        )
        at = MaterialPoints(F, rate, contraction, voltage, self._fibres[muscle], drive.time, shear)
        return self.effect.first_piola(at, self.values)

    def add_moduli(
        self, deformation: np.ndarray, rate: np.ndarray, drive, elastic: np.ndarray, viscous: np.ndarray
    ) -> None:
        """Add the derivatives by F and by its rate to elastic and viscous [elements, points, 4, 4]."""
        names, moduli = self.effect.depends_on, {"deformation": elastic, "rate": viscous}
        fields = {"deformation": deformation[self.elements], "rate": rate[self.elements]}
        shape = fields["deformation"].shape
        n, copies = shape[0] * shape[1], 8 * len(names)
        batch = {name: repeated(field.reshape(n, 4), copies) for name, field in fields.items()}
        for index, name in enumerate(names):
            moved = batch[name].reshape(len(names), 4, 2, n, 4)[index]
            for component in range(4):
                moved[component, 0, :, component] += _DIFFERENCE[name]
                moved[component, 1, :, component] -= _DIFFERENCE[name]
        F, speed = (batch[name].reshape(-1, 2, 2) for name in ("deformation", "rate"))
        P = self._evaluate(F, speed, drive, shape[1], copies).reshape(len(names), 4, 2, n, 4)
        for index, name in enumerate(names):
            change = (P[index, :, 0] - P[index, :, 1]) / (2 * _DIFFERENCE[name])
            moduli[name][self.elements] += change.transpose(1, 2, 0).reshape(*shape, 4)

    def contraction_slopes(self, deformation: np.ndarray, rate: np.ndarray, drive) -> np.ndarray:
        """Derivative of the stress by the contraction of every muscle, [muscles, elements here, points, 4].

        A point knows the contraction of the muscle it lies in only, so one difference serves all.
        """
        more, less = (
            self.stress(deformation, rate, drive.with_contraction(drive.contraction + step))
            for step in (1e-6, -1e-6)
        )
        change = (more - less) / 2e-6
        here = self._muscle == np.arange(1, len(self._fibres))[:, None]
        return here[:, :, None, None] * change
