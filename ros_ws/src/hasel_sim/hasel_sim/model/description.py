"""What a model file may say: every key with its unit in its name, validated when read."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from hasel_sim.effects.base import Surroundings
from hasel_sim.model.actuation import Channel, Muscle
from hasel_sim.model.body import Body, Material
from hasel_sim.model.consistency import first_fault
from hasel_sim.model.medium import Medium
from hasel_sim.model.muscle_law import MuscleLaw
from hasel_sim.model.section import Finite, Name, NotNegative, Positive, Section

ANGLE_MARKERS = ("head", "middle", "tail")
"""The markers whose positions give the angle."""


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


class Description(Section):
    """A whole model file."""

    name: str
    body: Body
    material: Materials
    medium: Medium | None = None
    channels: tuple[Channel, ...] = ()
    muscles: tuple[Muscle, ...] = ()
    muscle_response: Literal["sloped_box", "first_order"] = "sloped_box"
    """How muscles follow what is commanded: the contraction at a limited rate (`slope`), or the drive itself through a
    first-order lag (`rise_time`, `fall_time`), as the pressure in a chamber does."""
    muscle: MuscleLaw | None = None
    """The law that muscles driven by a voltage follow, in place of an amplitude per voltage."""
    markers: dict[Name, Marker]
    numerics: Numerics = Numerics()
    effects: tuple[str, ...] = ()
    parameters: dict[str, ParameterEntry] = Field(default_factory=dict)

    @model_validator(mode="after")
    def _consistent(self) -> "Description":
        fault = first_fault(self)
        if fault:
            raise ValueError(fault)
        return self

    @property
    def surroundings(self) -> Surroundings | None:
        """What the effects of a fluid need to know; None for a body without medium."""
        if self.medium is None or self.body.depth_m is None:
            return None
        return Surroundings(
            self.medium.density_kg_per_m3,
            self.medium.viscosity_pa_s,
            self.body.depth_m,
            self.body.whole_length_m,
        )

    def marker_names(self) -> tuple[str, ...]:
        """Head, middle and tail, then the others in the file's order."""
        return (*ANGLE_MARKERS, *(name for name in self.markers if name not in ANGLE_MARKERS))
