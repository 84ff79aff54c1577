"""What every physical effect states, and the four places where one can act.

An effect is one class in one file. It holds no state: its parameter values come as the argument `p`, with one attribute
per parameter. At the parameters' null values the model is exactly the one without the effect. No effect writes a
derivative; the simulator records what the methods below compute and differentiates it (`hasel_sim.laws`), or takes
central differences where that cannot be.
"""

from dataclasses import dataclass
from enum import IntEnum
from types import SimpleNamespace
from typing import ClassVar

import numpy as np

from hasel_sim.effects.material_points import Coefficients, MaterialPoints
from hasel_sim.effects.site_state import SiteState, Surroundings, normal
from hasel_sim.mesh.mesh import Region

__all__ = [
    "Coefficients",
    "DriveEffect",
    "DriveStage",
    "Effect",
    "EffectParameter",
    "ForceEffect",
    "MaterialEffect",
    "MaterialPoints",
    "ObservationEffect",
    "SiteState",
    "Surroundings",
    "normal",
]


@dataclass(frozen=True)
class EffectParameter:
    """One number of an effect.

    null: value without effect; lower, upper: plausible range; typical: a size at which one would notice it;
    scan: values to try for a parameter that has no null of its own (a relaxation time while its modulus is zero), empty
    for one that has; difference: step of the central differences (0: a millionth of `typical`); usual: lowest and
    highest value that the source gives of such bodies, None where it gives none.
    """

    name: str
    symbol: str
    unit: str
    null: float
    lower: float
    upper: float
    typical: float
    source: str = ""
    scan: tuple[float, ...] = ()
    difference: float = 0.0
    usual: tuple[float, float] | None = None

    @property
    def step(self) -> float:
        """Step of the central differences by this parameter."""
        return self.difference or 1e-6 * max(abs(self.typical), abs(self.null))

    def around(self, value: float) -> tuple[float, float, float]:
        """Two values around this one, within the range, and their distance."""
        more = value + self.step if value + self.step <= self.upper else value
        less = value - self.step if value - self.step >= self.lower else value
        return more, less, more - less


class Effect:
    """Base of all effects; subclass one of the four places below, not this."""

    id: ClassVar[str]
    place: ClassVar[str]
    physics: ClassVar[str]
    equation: ClassVar[str]
    parameters: ClassVar[tuple[EffectParameter, ...]]
    signature: ClassVar[str] = ""
    confused_with: ClassVar[tuple[str, ...]] = ()
    separated_by: ClassVar[str] = ""
    citation: ClassVar[str] = ""
    needs_muscles: ClassVar[bool] = False
    needs_spine: ClassVar[bool] = False
    needs_antagonists: ClassVar[bool] = False
    """Whether it compares two muscles, and so needs a body with exactly two."""
    needs_medium: ClassVar[bool] = False
    """Whether it is a force of the fluid around the body, and so needs a model that says which fluid that is."""
    needs_strained_start: ClassVar[bool] = False
    """Whether it does nothing in runs that a straight body starts at rest, with no load on it."""
    quantity: ClassVar[str] = ""
    """The quantity that must drive the body, such as "voltage"; any where empty."""
    exclusive: ClassVar[str] = ""
    """Effects with the same non-empty word here do the same thing and are refused side by side."""
    source: ClassVar[str | None] = None
    """`path/to/file.py:ClassName` for a user's own effect."""
    text: ClassVar[str] = ""
    """The file of a user's own effect."""

    def null(self) -> dict[str, float]:
        """Parameter values at which the effect does nothing."""
        return {parameter.name: parameter.null for parameter in self.parameters}

    def is_null_at(self, values: SimpleNamespace) -> bool:
        """Whether it has no size at these values of its parameters, so that nothing it does needs to be called."""
        return all(getattr(values, p.name) == p.null for p in self.parameters if not p.scan)

    def typical(self) -> dict[str, float]:
        """Parameter values at which one would notice the effect."""
        return {parameter.name: parameter.typical for parameter in self.parameters}


class DriveStage(IntEnum):
    """Where along the drive a signal is changed; the chain runs in this order whatever the model file's."""

    COMMAND = 0
    SUPPLY = 1
    ELECTRODE = 2
    ZIPPING = 3
    TARGET = 4
    CONTRACTION = 5


class DriveEffect(Effect):
    """Between the commanded voltage and the contraction.

    Up to `ZIPPING` the signal is the signed drive of every channel (voltage [V], pressure [Pa] ...); at `TARGET` it is
    the contraction aimed at [1] of every muscle, at `CONTRACTION` the contraction itself. Equal times mark a jump:
    value before, value after.
    """

    place = "drive"
    needs_muscles = True
    stage: ClassVar[DriveStage] = DriveStage.SUPPLY
    sweeps: ClassVar[bool] = True
    """Whether, up to `ZIPPING`, it lets the drive pass levels that nobody commanded; then how a muscle contracts below
    its lowest known level matters, and the model has an onset."""

    def clock(self, time: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """When the signal's values take effect [s], shape [n]; unchanged by default."""
        return time

    def respond(self, time: np.ndarray, signal: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """The signal [n, channels or muscles] after this effect, from the one before it at times [s] [n]."""
        return signal


class ForceEffect(Effect):
    """A force on the body, per unit of what a site stands for and per unit depth.

    sites: "body" (per mass [N/kg]), "skin" (per skin length [N/m^2]), "line" (per length of the centre line at rest
    [N/m^2]) or "points" (force itself [N/m]).
    depends_on: which of position, velocity, acceleration, tangent, tangent_rate, contraction the force depends on.
    An effect at the line may have a `flux` besides; sheds: whether the tail leaves behind what is handed on to it.
    """

    place = "force"
    sites: ClassVar[str] = "body"
    depends_on: ClassVar[tuple[str, ...]] = ("position", "velocity")
    sheds: ClassVar[bool] = True

    def points(self, markers: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Reference positions [m] [n, 2] of the points acted on, given the three markers' [3, 2]."""
        return markers

    def force(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """Force at each site, [n, 2]."""
        raise NotImplementedError

    def flux(self, at: SiteState, p: SimpleNamespace) -> np.ndarray:
        """What is handed on along the centre line towards the nose [N/m], [n, 2].

        Its derivative along the line acts on the body besides the force, and at the tail it enters from behind: the sum
        of what it does to the body is its value at the tail, or nothing where the effect does not shed.
        """
        raise NotImplementedError

    @property
    def has_flux(self) -> bool:
        """Whether the effect has a flux."""
        return type(self).flux is not ForceEffect.flux


class MaterialEffect(Effect):
    """A change of the material: its constants, internal branches, rest shape or an additional stress."""

    place = "material"
    regions: ClassVar[tuple[Region, ...]] = ()
    """Where `first_piola` adds stress; empty for an effect without additional stress."""
    depends_on: ClassVar[tuple[str, ...]] = ("deformation",)
    """Which of deformation and rate the additional stress depends on."""

    def modify(self, coefficients: Coefficients, p: SimpleNamespace) -> None:
        """Change the constants in place."""

    def branches(self, p: SimpleNamespace) -> list[tuple[float, float]]:
        """Maxwell branches as (modulus ratio [1], relaxation time [s])."""
        return []

    def fading(self, p: SimpleNamespace) -> list[tuple[float, float]]:
        """Stress that a run starts with and that relaxes, as (share of the elastic stress [1], relaxation time [s])."""
        return []

    def first_piola(self, at: MaterialPoints, p: SimpleNamespace) -> np.ndarray:
        """Additional first Piola stress [Pa] [n, 2, 2] at material points."""
        raise NotImplementedError


class ObservationEffect(Effect):
    """Between where the markers are and the angle that is measured."""

    place = "observation"

    def look_ahead(self, p: SimpleNamespace) -> float:
        """How far beyond the last frame [s] the body must be simulated."""
        return 0.0

    def markers(self, positions: np.ndarray, across: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """Where the camera sees the markers [m] [n, 3, 2].

        positions: where they are on the centre line; across: the material line through them that was upright at rest,
        per metre, both [n, 3, 2].
        """
        return positions

    def angle(self, time: np.ndarray, sin_theta: np.ndarray, p: SimpleNamespace) -> np.ndarray:
        """The measured series [n] from the series at times [s] [n]."""
        return sin_theta
