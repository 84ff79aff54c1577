"""Coefficients of the generalised-alpha method, second order with chosen damping of what the step cannot resolve.

Forces and inertia are balanced once per step at interpolated positions, velocities and accelerations ("generalised
mid-point"); rho = 1 is the implicit mid-point rule, which keeps momentum and angular momentum.
J. Chung, G. M. Hulbert, J. Appl. Mech. 60 (1993) 371.
"""

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property

import numpy as np


@dataclass(frozen=True)
class StepCoefficients:
    """What one step of length `step` [s] does with the end-of-step acceleration a1.

    x = x0 + position_gain_v v0 + position_gain_a a0 + position_gain a1 where forces are balanced, and likewise for the
    velocity and the acceleration; the `end_` values lead to the end of the step.
    """

    step: float
    at: float
    position_v: float
    position_a: float
    position: float
    velocity_a: float
    velocity: float
    acceleration_a: float
    acceleration: float
    end_position_a: float
    end_position: float
    end_velocity_a: float
    end_velocity: float

    @cached_property
    def to_balance(self) -> np.ndarray:
        """Weights for `compiled.combine` that lead to where forces are balanced, [8, lanes]."""
        return _weights(
            self.position_v,
            self.position_a,
            self.position,
            self.velocity_a,
            self.velocity,
            self.acceleration_a,
            self.acceleration,
        )

    @cached_property
    def matrix_weights(self) -> np.ndarray:
        """Weights of stiffness, damping and mass in the matrix of a step, [3, lanes]."""
        return _weights(self.position, self.velocity, self.acceleration)[:3].copy()

    @cached_property
    def to_end(self) -> np.ndarray:
        """Weights for `compiled.combine` that lead to the end of the step, [8, lanes]."""
        return _weights(
            self.step,
            self.end_position_a,
            self.end_position,
            self.end_velocity_a,
            self.end_velocity,
            0.0,
            1.0,
        )

    @staticmethod
    def beside(each: Sequence["StepCoefficients"]) -> "StepCoefficients":
        """Those of several lanes, whose steps may differ in length: every coefficient an array [lanes]."""
        names = (field.name for field in fields(StepCoefficients))
        return StepCoefficients(**{name: np.array([getattr(c, name) for c in each]) for name in names})  # type: ignore[arg-type]

    def halved(self) -> "StepCoefficients":
        """Those of a step of half the length."""
        half = {name: 0.5 * getattr(self, name) for name in _LIKE_THE_STEP}
        return replace(self, **half, **{name: 0.25 * getattr(self, name) for name in _LIKE_ITS_SQUARE})


def _weights(*each: float | np.ndarray) -> np.ndarray:
    return np.array(np.broadcast_arrays(*map(np.atleast_1d, (*each, 0.0))), dtype=float)


_LIKE_THE_STEP = ("step", "at", "position_v", "velocity_a", "velocity", "end_velocity_a", "end_velocity")
_LIKE_ITS_SQUARE = ("position_a", "position", "end_position_a", "end_position")


def step_coefficients(step: float, rho: float) -> StepCoefficients:
    """Coefficients for a step [s] and a spectral radius rho (0 < rho <= 1) at infinite frequency."""
    alpha_m, alpha_f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    gamma = 0.5 - alpha_m + alpha_f
    beta = 0.25 * (1 - alpha_m + alpha_f) ** 2
    part = 1 - alpha_f
    return StepCoefficients(
        step=step,
        at=part * step,
        position_v=part * step,
        position_a=part * step**2 * (0.5 - beta),
        position=part * step**2 * beta,
        velocity_a=part * step * (1 - gamma),
        velocity=part * step * gamma,
        acceleration_a=alpha_m,
        acceleration=1 - alpha_m,
        end_position_a=step**2 * (0.5 - beta),
        end_position=step**2 * beta,
        end_velocity_a=step * (1 - gamma),
        end_velocity=step * gamma,
    )
