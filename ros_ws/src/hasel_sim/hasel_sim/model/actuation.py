"""The channels and muscles sections of a model file: what is commanded, and what it contracts."""

from typing import Literal

from hasel_recording.drive_channel import DriveChannel
from hasel_recording.errors import RecordingError
from pydantic import Field, model_validator

from hasel_sim.mesh.body_mesh import Stretch
from hasel_sim.model.body import LAYERS
from hasel_sim.model.section import Name, NotNegative, Positive, Section

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
