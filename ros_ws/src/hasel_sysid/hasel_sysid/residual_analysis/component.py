# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""One way in which a run differs from its simulation, with its size, in the words of a researcher at the plot."""

from dataclasses import asdict, dataclass
from enum import Enum
from typing import Any

_OUT_OF_PROPORTION = 5.0
"""A model that moves so many times less is no scale for a percentage."""


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


def _digits(value: float) -> str:
    return f"{value:.0f}" if value >= 9.5 else f"{value:.2g}"


def _milliseconds(value_s: float) -> str:
    return f"{_digits(value_s * 1e3)} ms"


def _percent(value: float) -> str:
    return f"{_digits(value * 100)} %"


def words(c: Component) -> str:
    """A component as a predicate, without full stop: "lags 35 ms after every switch"."""
    size, positive, beyond = abs(c.value), c.value > 0, abs(c.value) > _OUT_OF_PROPORTION
    more, grows = ("more", "grows") if positive else ("less", "fades")
    detail = c.detail or {}
    match c.kind:
        case Kind.OFFSET:
            return f"sits {size:.2g} {'above' if positive else 'below'} the model in sin θ"
        case Kind.GAIN if c.value < -1:
            return "moves against the model"
        case Kind.GAIN if positive and beyond:
            return "moves many times more than the model, which hardly moves"
        case Kind.GAIN:
            return f"moves {_percent(size)} {more} than the model"
        case Kind.LAG if positive:
            return f"lags {_milliseconds(size)} after every switch"
        case Kind.LAG:
            return f"leads the model by {_milliseconds(size)}"
        case Kind.RINGING:
            where = f" at {detail['frequency_hz']:.2g} Hz" if detail else ""
            return f"swings differently{where} after every switch, by {c.value:.2g} in sin θ at first"
        case Kind.RISE_AGAINST_FALL:
            slow, fast = ("bending away", "coming back") if positive else ("coming back", "bending away")
            return f"lags {_milliseconds(size)} more when {slow} than when {fast}"
        case Kind.UPPER_AGAINST_LOWER:
            times = "many times" if beyond else _percent(size)
            return f"bends {times} {more} to the lower than to the upper side"
        case Kind.GAIN_DRIFT if beyond:
            return f"{grows} many times over within a second against the model"
        case Kind.GAIN_DRIFT:
            return f"{grows} by {_percent(size)} per second against the model"
        case Kind.OFFSET_DRIFT:
            return f"wanders to the {'upper' if positive else 'lower'} side by {size:.2g} in sin θ per second"
        case Kind.SWING_FREQUENCY:
            text = f"swings {_percent(size)} {'faster' if positive else 'slower'} than the model"
            if "measured_hz" in detail:
                text += f" ({detail['measured_hz']:.3g} Hz against {detail['simulated_hz']:.3g} Hz)"
            return text
        case Kind.SWING_DECAY:
            text = f"dies out {'faster' if positive else 'slower'} than the model by {size:.2g} 1/s"
            if "measured_damping_ratio" in detail:
                text += (
                    f" (damping ratio {round(detail['measured_damping_ratio'], 3):g} "
                    f"against {round(max(detail['simulated_damping_ratio'], 0.0), 3):g})"
                )
            return text


@dataclass(frozen=True)
class Failure:
    """component: what and how much; where: name of the run, or "all runs"; remark: what it depends on, may be empty."""

    component: Component
    where: str
    remark: str = ""

    @property
    def size(self) -> float:
        """Rms of sin theta that it accounts for."""
        return self.component.size

    @property
    def predicate(self) -> str:
        """The sentence without its subject: "lags 35 ms after every switch, more at 3.5 Hz"."""
        return words(self.component) + (f", {self.remark}" if self.remark else "")

    def __str__(self) -> str:
        return f"{self.where}: {self.predicate} (rms {self.size:.2g} of sin θ)."

    def to_json(self) -> dict[str, Any]:
        """Plain numbers and words."""
        return {
            "kind": self.component.kind.value,
            "where": self.where,
            "value": self.component.value,
            "std": self.component.standard_error,
            "unit": self.component.unit,
            "size": self.size,
            "detail": asdict(self.component)["detail"],
            "sentence": str(self),
        }
