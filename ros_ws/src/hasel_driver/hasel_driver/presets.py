"""Protocols of the literature that a goal of `run_experiment` may name instead of spelling them out."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from hasel_driver.errors import LimitError
from hasel_driver.waveform import Waveform


@dataclass(frozen=True)
class Preset:
    """A waveform of which only the voltage is open, and the muscle; `rest_s` [s] at 0 V before and after."""

    meaning: str
    shape: str
    frequency_hz: float
    periods: int
    duty: float
    polarity: str
    rest_s: float

    def waveform(self, voltage_v: float, muscle: str) -> Waveform:
        """The waveform at a voltage [V]. Raises LimitError for more than one muscle: the bench holds one."""
        if muscle not in ("upper", "lower"):
            raise LimitError(f"A bench holds one muscle; muscles is {muscle!r}, upper or lower was expected.")
        return Waveform(
            self.shape, voltage_v, self.frequency_hz, self.periods, self.duty, self.polarity, muscle
        )


PRESETS: Mapping[str, Preset] = MappingProxyType(
    {
        # Kellaris, Gopaluni Venkata, Rothemund, Keplinger, Extreme Mechanics Letters 29 (2019) 100449
        "three_lifts": Preset(
            "a load lifted three times: a box of 0.1 Hz, 5 s on and 5 s off, its polarity reversed every time",
            shape="box",
            frequency_hz=0.1,
            periods=3,
            duty=1.0,
            polarity="alternating",
            rest_s=5.0,
        )
    }
)


def preset(name: str) -> Preset:
    """A preset by its name. Raises LimitError."""
    if name not in PRESETS:
        raise LimitError(f"preset is {name!r}, {', '.join(PRESETS)} or nothing was expected.")
    return PRESETS[name]
