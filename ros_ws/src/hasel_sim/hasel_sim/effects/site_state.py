"""Where a force effect acts: the motion and drive at its sites, and the fluid around them."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.errors import ModelError


@dataclass(frozen=True)
class Surroundings:
    """The fluid around a body and what of the body it meets.

    density [kg/m^3]; viscosity: dynamic [Pa s]; depth: of the body, out of the plane [m]; length: nose to tail [m].
    """

    density: float
    viscosity: float
    depth: float
    length: float

    @property
    def kinematic_viscosity(self) -> float:
        """Viscosity over density [m^2/s]."""
        return self.viscosity / self.density


@dataclass(frozen=True)
class SiteState:
    """Motion and drive at n places; arrays are [n, 2] unless said.

    position [m], velocity [m/s], acceleration [m/s^2], tangent: derivative of the position along the skin, or along the
    centre line towards the tail [1]; tangent_rate: the same of the velocity [1/s];
    reference: position at rest [m]; rest_normal: outward unit normal of the skin at rest; measure [n]: mass [kg per m
    depth], skin length [m] or 1; voltage (drive [V], [Pa] ...) and contraction [1]: of every muscle, [muscles];
    time [s]; gravity [m/s^2], shape [2]; surroundings: the fluid, None for a model without `medium`.
    """

    position: np.ndarray
    velocity: np.ndarray
    acceleration: np.ndarray
    tangent: np.ndarray
    tangent_rate: np.ndarray
    reference: np.ndarray
    rest_normal: np.ndarray
    measure: np.ndarray
    voltage: np.ndarray
    contraction: np.ndarray
    time: float
    gravity: np.ndarray
    surroundings: Surroundings | None = None

    @property
    def normal(self) -> np.ndarray:
        """Unit normal as it is now, outward from the skin or to the right of the centre line, [n, 2].

        A force that uses it depends on the tangent.
        """
        return normal(self.tangent)

    @property
    def fluid(self) -> Surroundings:
        """The fluid around the body, for an effect that needs a medium. Raises ModelError where there is none."""
        if self.surroundings is None:
            raise ModelError(
                "the model says nothing of the fluid around the body; expected a section medium: add one, and set "
                "needs_medium = True in the effect"
            )
        return self.surroundings


def normal(tangent: np.ndarray) -> np.ndarray:
    """Unit normal [n, 2] to the right of these tangents [n, 2], which is outward from the skin."""
    along, across = tangent[:, 0], tangent[:, 1]
    length = np.sqrt(along * along + across * across)  # hypot guards against overflow, at twice the time
    out = np.empty_like(tangent)
    out[:, 0], out[:, 1] = across / length, -along / length
    return out
