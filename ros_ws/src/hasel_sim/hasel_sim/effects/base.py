# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What every physical effect states, the four places where one can act, and what it finds there.

An effect is one class in one file. It holds no state: its parameter values come as the argument `p`, with one attribute
per parameter. At the parameters' null values the model is exactly the one without the effect. No effect writes a
derivative; the simulator records what the methods below compute and differentiates it (`hasel_sim.laws`), or takes
central differences where that cannot be.
"""

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property
from types import SimpleNamespace
from typing import Any, ClassVar

import numpy as np

from hasel_sim.errors import HaselSimError, ModelError
from hasel_sim.mesh.mesh import Region


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


def guarded(effect: Effect, method: str, *arguments: Any) -> Any:
    """What a method returns; any failure of it becomes a ModelError that names effect and method."""
    try:
        return getattr(effect, method)(*arguments)
    except HaselSimError:
        raise
    except Exception as error:
        raise ModelError(
            f"effect '{effect.source or effect.id}' fails in {method} ({type(error).__name__}: {error}): "
            "correct that method"
        ) from error
