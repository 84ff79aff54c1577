"""What a material effect changes, and where it adds stress: constants per element, strain and drive at points."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np


@dataclass
class Coefficients:
    """Material constants per element, shape [elements]; an effect changes them in place.

    shear, lame: elastic constants [Pa]; equilibrium: share of them that acts for ever [1] (viscosity and branches keep
    the whole); retardation: Kelvin-Voigt time [s]; fibre: fibre stiffness [Pa]; region: `Region` of each element;
    rest_stretch: stretch along the body of the stress-free shape [elements, points];
    height: reference y of the Gauss points [m] [elements, points].
    """

    shear: np.ndarray
    lame: np.ndarray
    equilibrium: np.ndarray
    retardation: np.ndarray
    fibre: np.ndarray
    region: np.ndarray
    rest_stretch: np.ndarray
    height: np.ndarray


@dataclass(frozen=True)
class MaterialPoints:
    """Strain and drive at n material points.

    deformation: gradient F [n, 2, 2] with the first axis along the body at rest, rate: dF/dt [1/s] [n, 2, 2];
    contraction [1] and voltage (drive [V], [Pa] ...): of the muscle here [n] (0 in none); fibre: stiffness of its
    fibres [Pa], [n] or one number; time [s]; shear: shear modulus of the soft solid here [Pa], [n] or one number.
    """

    deformation: np.ndarray
    rate: np.ndarray
    contraction: np.ndarray
    voltage: np.ndarray
    fibre: np.ndarray
    time: float
    shear: np.ndarray | float = 0.0

    @cached_property
    def volume_ratio(self) -> np.ndarray:
        """Determinant J of the deformation gradient [1], [n]."""
        F = self.deformation
        return F[:, 0, 0] * F[:, 1, 1] - F[:, 0, 1] * F[:, 1, 0]

    @property
    def distortion(self) -> np.ndarray:
        """F - F^-T, the first Piola stress per shear modulus of a neo-Hookean solid [n, 2, 2]."""
        F = self.deformation
        cofactor = np.empty_like(F)
        cofactor[:, 0, 0], cofactor[:, 0, 1] = F[:, 1, 1], -F[:, 1, 0]
        cofactor[:, 1, 0], cofactor[:, 1, 1] = -F[:, 0, 1], F[:, 0, 0]
        return F - cofactor / self.volume_ratio[:, None, None]

    @cached_property
    def stretch(self) -> np.ndarray:
        """Stretch of the fibres [1], [n]."""
        along, across = self.deformation[:, 0, 0], self.deformation[:, 1, 0]
        return np.sqrt(along * along + across * across)  # hypot guards against overflow, at twice the time

    def along_fibre(self, tension: np.ndarray) -> np.ndarray:
        """First Piola stress [Pa] [n, 2, 2] of a tension [Pa] [n] along the fibres."""
        stress = np.zeros_like(self.deformation)
        stress[:, :, 0] = (tension / self.stretch)[:, None] * self.deformation[:, :, 0]
        return stress
