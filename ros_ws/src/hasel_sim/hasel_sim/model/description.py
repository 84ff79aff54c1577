"""What a model file may say: every key with its unit in its name, validated when read."""

from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, model_validator

from hasel_sim.mesh.bodies import outline_fault

Positive = Annotated[float, Field(gt=0, allow_inf_nan=False)]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False)]
Finite = Annotated[float, Field(allow_inf_nan=False)]


class _Section(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class SwimmerBody(_Section):
    """Soft halves on a thin spine that goes on as the tail fin; the nose is at x = 0."""

    kind: Literal["swimmer"]
    body_length_m: Positive
    fin_length_m: Positive
    spine_thickness_m: Positive
    largest_half_height_m: Positive
    outline_coefficients: Annotated[tuple[Finite, ...], Field(min_length=1)]
    head_length_m: Positive
    muscle_end_m: Positive
    clamped: Literal[False] = False

    @model_validator(mode="after")
    def _in_order(self) -> "SwimmerBody":
        if not self.head_length_m < self.muscle_end_m < self.body_length_m:
            raise ValueError(
                "expected head_length_m < muscle_end_m < body_length_m: correct these three lengths"
            )
        fault = outline_fault(
            np.array(self.outline_coefficients),
            self.largest_half_height_m,
            self.spine_thickness_m,
            self.body_length_m,
        )
        if fault:
            raise ValueError(fault)
        return self

    @property
    def whole_length_m(self) -> float:
        """From the nose to the fin's tip [m]."""
        return self.body_length_m + self.fin_length_m


class RectangleBody(_Section):
    """A plain rectangle from x = 0 to its length, its centre line at y = 0."""

    kind: Literal["rectangle"]
    length_m: Positive
    height_m: Positive
    clamped: bool = False

    @property
    def whole_length_m(self) -> float:
        """From end to end [m]."""
        return self.length_m


class Material(_Section):
    """An isotropic solid; the retardation time is that of its Kelvin-Voigt damping."""

    youngs_modulus_pa: Positive
    poissons_ratio: Annotated[float, Field(gt=-1, lt=0.5)]
    density_kg_per_m3: Positive
    retardation_time_s: NotNegative


class Materials(_Section):
    """The soft material and, for a swimmer, the spine's."""

    soft: Material
    spine: Material | None = None
    plane: Literal["strain", "stress"] = "strain"
    gravity_m_per_s2: tuple[Finite, Finite] = (0.0, 0.0)


class Muscle(_Section):
    """Contractile fibres along the body in both muscle regions."""

    fibre_stiffness_pa: Positive


class Marker(_Section):
    """A marker on the centre line; a fixed one belongs to the rig and does not move."""

    x_m: Finite
    fixed: bool = False


class Markers(_Section):
    """The three markers whose positions give the angle."""

    head: Marker
    middle: Marker
    tail: Marker


class Numerics(_Section):
    """Mesh density 1 is the default mesh; a time step is at most 1 / steps_per_second.

    quadrature_order: Gauss points per direction of an element; 2 is softer and converges faster, 3 is full.
    """

    mesh_density: Positive = 1.0
    quadrature_order: Literal[2, 3] = 3
    steps_per_second: Positive = 240.0
    spectral_radius: Annotated[float, Field(gt=0, le=1)] = 0.9
    tolerance_m: Positive = 1e-8


class ParameterEntry(_Section):
    """One entry of the file's parameters."""

    value: Finite
    unit: str = "1"
    lower: Finite | None = None
    upper: Finite | None = None
    free: bool = True
    standard_error: NotNegative | None = None


class Description(_Section):
    """A whole model file."""

    name: str
    body: Annotated[SwimmerBody | RectangleBody, Field(discriminator="kind")]
    material: Materials
    muscle: Muscle | None = None
    markers: Markers
    numerics: Numerics = Numerics()
    effects: tuple[str, ...] = ()
    parameters: dict[str, ParameterEntry] = {}

    @model_validator(mode="after")
    def _complete(self) -> "Description":
        if self.body.kind == "swimmer" and (self.material.spine is None or self.muscle is None):
            raise ValueError("a swimmer needs material.spine and muscle: add both sections")
        length = self.body.whole_length_m
        for name in ("head", "middle", "tail"):
            marker = getattr(self.markers, name)
            if not marker.fixed and not 0 <= marker.x_m <= length + 1e-9:
                raise ValueError(
                    f"markers.{name}.x_m is {marker.x_m:g}; expected 0 to {length:g} m, a place on the body: correct "
                    "it or set fixed: true for a marker of the rig"
                )
        return self
