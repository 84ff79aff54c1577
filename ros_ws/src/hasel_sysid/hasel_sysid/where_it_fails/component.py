"""One way in which a run differs from its simulation, with its size."""

from dataclasses import dataclass
from enum import Enum


class Kind(str, Enum):
    """What a difference looks like."""

    OFFSET = "offset"
    GAIN = "gain"
    LAG = "lag"
    RINGING = "ringing"
    RISE_AGAINST_FALL = "rise against fall"
    UPPER_AGAINST_LOWER = "upper against lower"
    GAIN_DRIFT = "drift of the gain"
    OFFSET_DRIFT = "drift of the offset"
    SWING_FREQUENCY = "swing frequency"
    SWING_DECAY = "swing decay"


@dataclass(frozen=True)
class Component:
    """size: rms of sin theta that this difference alone accounts for; value and standard_error in `unit` (SI).

    detail: further numbers by name, such as the frequency_hz of a ringing.
    """

    kind: Kind
    value: float
    standard_error: float
    unit: str
    size: float
    detail: dict[str, float] | None = None

    @property
    def significance(self) -> float:
        """Value in units of its standard error."""
        return abs(self.value) / self.standard_error if self.standard_error > 0 else 0.0
