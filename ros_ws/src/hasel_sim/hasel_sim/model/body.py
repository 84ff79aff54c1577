"""The body section of a model file: one description for every planar strip."""

from typing import Literal

import numpy as np
from pydantic import Field, model_validator

from hasel_sim.mesh.body_mesh import Stretch, StripShape, half_height, outline_fault
from hasel_sim.model.section import Finite, Name, NotNegative, Positive, Section

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
        fault = outline_fault(
            np.array(self.coefficients), self.largest_half_height_m, self.spine_thickness_m, self.length_m
        )
        if fault:
            raise ValueError(fault)
        return self

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
