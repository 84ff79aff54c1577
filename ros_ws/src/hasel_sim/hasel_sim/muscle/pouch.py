# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Geometry and electrostatics of one Peano-HASEL pouch: a bag of inextensible film with liquid that zips from one end.

The liquid's cross-section A stays what it is. What is not zipped is bounded by two circular arcs of half angle alpha
and film length l_p, so that A = l_p^2 (alpha - sin alpha cos alpha) / (2 alpha^2); the electrodes are zipped over
l_e = L_p - l_p, a plate capacitor of two films. Kellaris, Gopaluni Venkata, Rothemund, Keplinger, Extreme Mechanics
Letters 29 (2019) 100449; the force follows from virtual work at constant voltage, F dx = V^2 dC / 2.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np
from scipy.optimize import brentq

from hasel_sim.errors import ModelError

_Angle = TypeVar("_Angle", float, np.ndarray)

VACUUM_PERMITTIVITY = 8.8541878128e-12
"""[F/m]"""
_CYLINDER = np.pi / 2


@dataclass(frozen=True)
class Pouch:
    """One pouch. Lengths [m]: film_length between two seals, electrode_length of it under electrodes, width across,
    film_thickness of one film; relative_permittivity of the film [1].

    fill: liquid by that with which the free part is just a cylinder when the whole electrode is zipped [1].
    """

    film_length: float
    electrode_length: float
    width: float
    film_thickness: float
    relative_permittivity: float
    fill: float = 1.0

    def __post_init__(self) -> None:
        if not 0 < self.electrode_length < self.film_length:
            raise ModelError(
                f"a pouch has {self.electrode_length:g} m of electrodes on {self.film_length:g} m of film; expected "
                "less than the film's length: correct one of the two"
            )
        if not 0 < self.fill < self.largest_fill:
            raise ModelError(
                f"a pouch is filled to {self.fill:g} of a full zip's cylinder; expected above 0 and below "
                f"{self.largest_fill:.3g}, where all of its film is a cylinder: correct the fill"
            )

    @property
    def largest_fill(self) -> float:
        """Fill at which the pouch is a cylinder before it zips, and cannot contract."""
        return (self.film_length / (self.film_length - self.electrode_length)) ** 2

    @property
    def area(self) -> float:
        """Cross-section of the liquid [m^2]."""
        return self.fill * (self.film_length - self.electrode_length) ** 2 / np.pi

    @cached_property
    def relaxed_angle(self) -> float:
        """Half angle [rad] of the arcs without voltage, when all of the film is free."""
        aim = self.area / self.film_length**2
        return float(brentq(lambda angle: _segment(angle) / (2 * angle**2) - aim, 1e-6, np.pi / 2))

    @cached_property
    def largest_angle(self) -> float:
        """Half angle [rad] at which zipping ends: at the electrode's end, or where the free part is a cylinder."""
        free = self.film_length - self.electrode_length
        if float(self.arc(np.array(_CYLINDER))) >= free:
            return _CYLINDER
        return float(
            brentq(lambda angle: float(self.arc(np.array(angle))) - free, self.relaxed_angle, _CYLINDER)
        )

    def arc(self, angle: np.ndarray) -> np.ndarray:
        """Length l_p [m] of the free film at a half angle [rad]."""
        return angle * np.sqrt(2 * self.area / _segment(angle))

    def zipped(self, angle: np.ndarray) -> np.ndarray:
        """Zipped length l_e [m]."""
        return self.film_length - self.arc(angle)

    @property
    def relaxed_length(self) -> float:
        """Distance of the seals [m] without voltage."""
        return self.film_length * float(np.sin(self.relaxed_angle) / self.relaxed_angle)

    def contraction(self, angle: np.ndarray) -> np.ndarray:
        """How much nearer to each other the seals have come [m]."""
        length = self.arc(angle)
        return self.relaxed_length - self.film_length + length - length * np.sin(angle) / angle

    @property
    def largest_contraction(self) -> float:
        """Free stroke [m]."""
        return float(self.contraction(np.array(self.largest_angle)))

    @property
    def capacitance_per_zipped_length(self) -> float:
        """dC/dl_e [F/m]: two films in series."""
        return VACUUM_PERMITTIVITY * self.relative_permittivity * self.width / (2 * self.film_thickness)

    def capacitance(self, angle: np.ndarray) -> np.ndarray:
        """Capacitance of the zipped part [F]."""
        return self.capacitance_per_zipped_length * self.zipped(angle)

    def force(self, voltage: np.ndarray, angle: np.ndarray) -> np.ndarray:
        """Force along the muscle [N] at a voltage [V]: (dC/dl_e / 2) V^2 cos alpha / (1 - cos alpha)."""
        half = 0.5 * self.capacitance_per_zipped_length
        return half * np.square(voltage) * np.cos(angle) / (1 - np.cos(angle))

    def angle_under_load(self, voltage: np.ndarray, load: np.ndarray) -> np.ndarray:
        """Half angle [rad] at which a voltage [V] holds a load [N]; at the limits of the pouch where it cannot."""
        pull = 0.5 * self.capacitance_per_zipped_length * np.square(voltage)
        with np.errstate(divide="ignore", invalid="ignore"):
            cosine = np.where(load > 0, load / (pull + load), np.where(pull > 0, 0.0, 1.0))
        return np.clip(np.arccos(np.clip(cosine, 0.0, 1.0)), self.relaxed_angle, self.largest_angle)


def bisect(function: Callable[[np.ndarray], np.ndarray], low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Where an increasing function of arrays changes its sign, between low and high; an end where it does not."""
    for _ in range(44):
        middle = 0.5 * (low + high)
        below = function(middle) < 0
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    return 0.5 * (low + high)


def _segment(angle: _Angle) -> _Angle:
    """alpha - sin alpha cos alpha, without cancellation at small angles."""
    return 0.5 * (2 * angle - np.sin(2 * angle))
