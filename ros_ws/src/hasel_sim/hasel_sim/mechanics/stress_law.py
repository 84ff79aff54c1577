"""A material effect that adds stress, bound to the Gauss points of its regions."""

from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import MaterialEffect, MaterialPoints

_DIFFERENCE_F, _DIFFERENCE_RATE = 1e-6, 1e-4


class StressLaw:
    """One additional stress at the Gauss points of the elements it concerns; derivatives by central differences."""

    def __init__(
        self,
        effect: MaterialEffect,
        values: SimpleNamespace,
        region: np.ndarray,
        muscle: np.ndarray,
        fibre: float = 0.0,
    ) -> None:
        self.effect, self.values, self._fibre = effect, values, fibre
        self.elements = np.flatnonzero(np.isin(region, [int(r) for r in effect.regions]))
        self._muscle = muscle[self.elements]

    def stress(self, deformation: np.ndarray, rate: np.ndarray, drive) -> np.ndarray:
        """First Piola stress at [elements here, points, 4] for gradients and rates of all elements [.., points, 4]."""
        here, speed = deformation[self.elements], rate[self.elements]
        return self._evaluate(
            here.reshape(-1, 2, 2), speed.reshape(-1, 2, 2), drive, here.shape[1], 1
        ).reshape(here.shape)

    def _evaluate(self, F: np.ndarray, rate: np.ndarray, drive, points: int, copies: int) -> np.ndarray:
        muscle = np.tile(np.repeat(self._muscle, points), copies)
        contraction, voltage = (
            np.concatenate([[0.0], of_both])[muscle] for of_both in (drive.contraction, drive.voltage)
        )
        at = MaterialPoints(F, rate, contraction, voltage, self._fibre, drive.time)
        return self.effect.first_piola(at, self.values)

    def add_moduli(
        self, deformation: np.ndarray, rate: np.ndarray, drive, elastic: np.ndarray, viscous: np.ndarray
    ) -> None:
        """Add the derivatives by F and by its rate to elastic and viscous [elements, points, 4, 4]."""
        here, speed = deformation[self.elements], rate[self.elements]
        points, n = here.shape[1], here.shape[0] * here.shape[1]
        F = np.tile(here.reshape(n, 4), (16, 1)).reshape(16, n, 4)
        R = np.tile(speed.reshape(n, 4), (16, 1)).reshape(16, n, 4)
        for component in range(4):
            F[2 * component, :, component] += _DIFFERENCE_F
            F[2 * component + 1, :, component] -= _DIFFERENCE_F
            R[8 + 2 * component, :, component] += _DIFFERENCE_RATE
            R[9 + 2 * component, :, component] -= _DIFFERENCE_RATE
        P = self._evaluate(F.reshape(-1, 2, 2), R.reshape(-1, 2, 2), drive, points, 16).reshape(8, 2, n, 4)
        change = (P[:, 0] - P[:, 1]).transpose(1, 2, 0).reshape(here.shape[0], points, 4, 8)
        elastic[self.elements] += change[..., :4] / (2 * _DIFFERENCE_F)
        viscous[self.elements] += change[..., 4:] / (2 * _DIFFERENCE_RATE)

    def contraction_slope(self, deformation: np.ndarray, rate: np.ndarray, drive, muscle: int) -> np.ndarray:
        """Derivative of the stress by the contraction of one muscle (0 upper, 1 lower), [elements here, points, 4]."""
        step = np.zeros(2)
        step[muscle] = 1e-6
        more = self.stress(deformation, rate, drive.with_contraction(drive.contraction + step))
        less = self.stress(deformation, rate, drive.with_contraction(drive.contraction - step))
        return (more - less) / 2e-6
