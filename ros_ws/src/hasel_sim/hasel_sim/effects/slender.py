# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What hydrodynamic effects share: velocities along and across the centre line, and the fluid that a strip carries."""

from dataclasses import dataclass

import numpy as np
from scipy.special import ellipe

from hasel_sim.effects.base import SiteState, Surroundings


@dataclass(frozen=True)
class LineMotion:
    """Motion of the centre line in its own directions.

    tangent (towards the tail) and normal [n, 2]; along, across: velocity [m/s] [n].
    """

    tangent: np.ndarray
    normal: np.ndarray
    along: np.ndarray
    across: np.ndarray

    @staticmethod
    def at(at: SiteState) -> "LineMotion":
        """That of the sites; effects that are called with one state share it."""
        known = vars(at)
        if "line_motion" not in known:
            known["line_motion"] = LineMotion._found(at)
        return known["line_motion"]

    @staticmethod
    def _found(at: SiteState) -> "LineMotion":
        tangent = at.tangent / np.hypot(at.tangent[:, 0], at.tangent[:, 1])[:, None]
        normal = np.stack([tangent[:, 1], -tangent[:, 0]], axis=1)
        return LineMotion(tangent, normal, dot(at.velocity, tangent), dot(at.velocity, normal))


def dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Products of the rows of two arrays [n, 2], [n]."""
    return a[:, 0] * b[:, 0] + a[:, 1] * b[:, 1]


def growth_of_momentum(at: SiteState) -> np.ndarray:
    """Rate at which w n grows with the body [m/s^2] [n, 2]: what fluid beside it gains, per mass."""
    motion = LineMotion.at(at)
    turning = dot(at.tangent_rate, motion.normal) / np.hypot(at.tangent[:, 0], at.tangent[:, 1])
    faster = dot(at.acceleration, motion.normal) - turning * motion.along
    return faster[:, None] * motion.normal - (motion.across * turning)[:, None] * motion.tangent


def strip_added_mass(fluid: Surroundings) -> float:
    """Mass of fluid that a long thin strip carries across, per length and depth [kg/m^2]: rho pi H / 4.

    Lamb, Hydrodynamics, 6th ed. (1932), section 71.
    """
    return fluid.density * np.pi * fluid.depth / 4.0


def finite_length_factor(fluid: Surroundings) -> float:
    """How much less fluid [1] a plate as long and deep as the body carries than a piece of an endless strip.

    Exact for an elliptic plate with these axes: 1 / E(e), E the complete elliptic integral of the second kind, e the
    plate's excentricity (Lamb, section 114 with 373): 1 for a slender body, 2 / pi for a disc.
    """
    short, long = sorted((fluid.depth, fluid.length))
    slender = 1.0 / float(ellipe(1.0 - (short / long) ** 2))
    return slender * short / fluid.depth
