# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The sections of a model file: known keys only, each with its unit in its name, finite numbers, never changed."""

from typing import Annotated, Any, Literal

import numpy as np
from hasel_common.names import nearest_name
from hasel_recording.drive_channel import DriveChannel
from hasel_recording.errors import RecordingError
from pydantic import BaseModel, ConfigDict, Field, model_validator

from hasel_sim.mesh.body_mesh import Stretch, StripShape, half_height, outline_fault

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]
Name = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]*$")]
"""A name that can stand in columns, parameters and topics: small letters, digits and underscores."""


class Section(BaseModel):
    """Base of all sections of a model file."""

    model_config = ConfigDict(extra="forbid", frozen=True)


Layer = Literal["upper", "lower", "soft", "spine", "whole"]
LAYERS: dict[str, tuple[str, ...]] = {
    "upper": ("upper",),
    "lower": ("lower",),
    "soft": ("upper", "lower"),
    "spine": ("spine",),
    "whole": ("upper", "spine", "lower"),
}
"""The layers of the mesh that each word means; `soft` is both halves without the spine."""


class Material(Section):
    """An isotropic solid; the retardation time is that of its Kelvin-Voigt damping."""

    youngs_modulus_pa: Positive
    poissons_ratio: float = Field(gt=-1, lt=0.5)
    density_kg_per_m3: Positive
    retardation_time_s: NotNegative


class Outline(Section):
    """Half height / largest half height = sum of c_i s^i, s = x / length."""

    largest_half_height_m: Positive
    coefficients: tuple[Finite, ...] = Field(min_length=1)


class Spine(Section):
    """A thin layer along the centre line; fin_length_m is how far it goes on behind the body, as the tail fin."""

    thickness_m: Positive
    fin_length_m: NotNegative = 0.0


class BodyRegion(Section):
    """A piece of the body of another material, such as a stiff head."""

    name: Name
    from_m: NotNegative
    to_m: Positive
    layer: Layer = "whole"
    material: Material

    @property
    def stretch(self) -> Stretch:
        """Where it lies."""
        return Stretch(self.from_m, self.to_m, LAYERS[self.layer])


class TipPlate(Section):
    """A plate on the face at the far end: its mass and its rotary inertia about the centre line, per m of depth."""

    mass_kg_per_m: NotNegative
    rotary_inertia_kg_m: NotNegative = 0.0


class Body(Section):
    """A planar strip from x = 0 to its length, y upwards from the centre line, of one height or with an outline."""

    length_m: Positive
    depth_m: Positive | None = None
    """Out of the plane; needed in a fluid, which flows around the edges."""
    height_m: Positive | None = None
    outline: Outline | None = None
    spine: Spine | None = None
    clamped: bool = False
    regions: tuple[BodyRegion, ...] = ()
    tip_plate: TipPlate | None = None

    @model_validator(mode="after")
    def _sound(self) -> "Body":
        if (self.height_m is None) == (self.outline is None):
            raise ValueError("expected either height_m or outline: give one of the two")
        if self.outline_fault:
            raise ValueError(self.outline_fault)
        return self

    @property
    def outline_fault(self) -> str | None:
        """What is wrong with an outline that crosses the spine or itself; None where nothing is."""
        return outline_fault(
            np.array(self.coefficients), self.largest_half_height_m, self.spine_thickness_m, self.length_m
        )

    @property
    def coefficients(self) -> tuple[float, ...]:
        """The outline's coefficients; (1,) for a body of one height."""
        return (1.0,) if self.outline is None else self.outline.coefficients

    @property
    def largest_half_height_m(self) -> float:
        """Scale of the outline [m]."""
        return 0.5 * self.height_m if self.outline is None else self.outline.largest_half_height_m

    @property
    def spine_thickness_m(self) -> float:
        """Of the spine [m]; 0 without one."""
        return self.spine.thickness_m if self.spine else 0.0

    @property
    def whole_length_m(self) -> float:
        """From x = 0 to the end of the body or its fin [m]."""
        return self.length_m + (self.spine.fin_length_m if self.spine else 0.0)

    def half_heights(self, s: np.ndarray) -> np.ndarray:
        """Half the height [m] of the body, without its fin, at s = x / length [n]."""
        return half_height(np.array(self.coefficients), self.largest_half_height_m, s)

    def with_outline(self, coefficients: tuple[float, ...]) -> "Body":
        """The same body with other outline coefficients, not checked."""
        return self.model_copy(
            update={"outline": self.outline.model_copy(update={"coefficients": coefficients})}
        )

    def half_height_at(self, x: float) -> float:
        """Half the height [m] of the body, or of its fin, at x [m]."""
        if x > self.length_m:
            return 0.5 * self.spine_thickness_m
        return float(half_height(np.array(self.coefficients), self.largest_half_height_m, x / self.length_m))

    def shape(self, muscles: tuple[Stretch, ...]) -> StripShape:
        """What the mesh follows."""
        return StripShape(
            self.length_m,
            self.largest_half_height_m,
            self.coefficients,
            self.spine_thickness_m,
            self.whole_length_m - self.length_m,
            self.clamped,
            muscles,
            tuple(region.stretch for region in self.regions),
        )


MuscleLayer = Literal["upper", "lower", "soft"]


class Channel(Section):
    """Something that can be commanded: a voltage, a pressure, a tendon's travel; largest: what it may rise to."""

    name: Name
    quantity: str = "voltage"
    unit: str = "V"
    largest: Positive | None = None
    largest_contraction: Positive = 0.6
    """Upper bound of the amplitudes; above 1 for weak fibres that stand for a stress, as a pressure is one."""
    own_amplitudes: bool = False
    """Whether its contraction per level differs from that of the other channels of the same quantity."""

    @model_validator(mode="after")
    def _known(self) -> "Channel":
        try:
            DriveChannel(self.name, self.quantity, self.unit)
        except RecordingError as error:
            raise ValueError(str(error)) from None
        return self

    @property
    def column(self) -> DriveChannel:
        """The channel as a recording knows it."""
        return DriveChannel(self.name, self.quantity, self.unit)


class MuscleRegion(Section):
    """Contractile fibres along the body from from_m to to_m, in one half or both.

    rest_contraction: how much shorter than the body its fibres are when nothing is commanded (pretension).
    """

    name: Name
    channel: str
    layer: MuscleLayer
    from_m: NotNegative
    to_m: Positive
    fibre_stiffness_pa: Positive
    rest_contraction: float = Field(default=0.0, ge=0.0, lt=0.5)

    @property
    def stretch(self) -> Stretch:
        """Where it lies."""
        return Stretch(self.from_m, self.to_m, LAYERS[self.layer])


FLUIDS: dict[str, tuple[float, float]] = {
    "canola_oil": (920.0, 0.07),
    "water": (998.0, 1.0e-3),
    "air": (1.2, 1.8e-5),
}
"""Density [kg/m^3] and dynamic viscosity [Pa s] at room temperature.

Oil: 0.07 Pa s within 20 %, which is what 18 to 25 degrees C and the spread between oils amount to (Diamante and Lan,
Journal of Food Processing 2014, 234583).
"""


class Medium(Section):
    """A fluid by its name, or by density and viscosity; what is given beside a name replaces the known value."""

    fluid: str | None = None
    density_kg_per_m3: Positive
    viscosity_pa_s: Positive

    @model_validator(mode="before")
    @classmethod
    def _known(cls, content: Any) -> Any:
        given = {"fluid": content} if isinstance(content, str) else content
        if not isinstance(given, dict) or given.get("fluid") is None:
            return given
        if given["fluid"] not in FLUIDS:
            raise ValueError(
                f"the fluid '{given['fluid']}' is not known; {nearest_name(str(given['fluid']), FLUIDS)}: give "
                "density_kg_per_m3 and viscosity_pa_s instead of a name"
            )
        density, viscosity = FLUIDS[given["fluid"]]
        return {"density_kg_per_m3": density, "viscosity_pa_s": viscosity, **given}


class Materials(Section):
    """The soft material and, for a body with a spine, the spine's."""

    soft: Material
    spine: Material | None = None
    plane: Literal["strain", "stress"] = "strain"
    gravity_m_per_s2: tuple[Finite, Finite] = (0.0, 0.0)


class Marker(Section):
    """A marker at a place on the body at rest; a fixed one belongs to the rig and does not move."""

    x_m: Finite
    y_m: Finite = 0.0
    fixed: bool = False


class Numerics(Section):
    """Mesh density 1 is the default mesh; a time step is at most 1 / steps_per_second.

    mesh_density scales the number of elements along the body, layers is the number through each soft half;
    quadrature_order: Gauss points per direction of an element; 2 is softer and converges faster, 3 is full.
    amplitude_curve: how a muscle contracts between levels whose amplitudes are known, cubic or a power of the level.
    """

    mesh_density: Positive = 1.0
    layers: Annotated[int, Field(ge=1)] = 1
    quadrature_order: Literal[2, 3] = 2
    steps_per_second: Positive = 240.0
    spectral_radius: Annotated[float, Field(gt=0, le=1)] = 0.9
    tolerance_m: Positive = 1e-8
    amplitude_curve: Literal["cubic", "power"] = "cubic"


class ParameterEntry(Section):
    """One entry of the file's parameters; a constant of the file that is freed needs no value and no unit."""

    value: Finite | None = None
    unit: str | None = None
    lower: Finite | None = None
    upper: Finite | None = None
    free: bool = True
    standard_error: NotNegative | None = None
    correlations: dict[str, Annotated[float, Field(ge=-1, le=1)]] = Field(default_factory=dict)
