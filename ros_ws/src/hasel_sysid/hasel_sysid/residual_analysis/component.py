"""One way in which a run differs from its simulation, with its size, in the words of a researcher at the plot."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from enum import Enum

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
    return f"{_digits(abs(value_s) * 1e3)} ms"


def _percent(value: float) -> str:
    return f"{_digits(abs(value) * 100)} %"


def _offset(c: Component) -> str:
    return f"sits {abs(c.value):.2g} {'above' if c.value > 0 else 'below'} the model in sin θ"


def _gain(c: Component) -> str:
    if c.value < -1:
        return "moves against the model"
    if c.value > _OUT_OF_PROPORTION:
        return "moves many times more than the model, which hardly moves"
    return f"moves {_percent(c.value)} {'more' if c.value > 0 else 'less'} than the model"


def _lag(c: Component) -> str:
    if c.value > 0:
        return f"lags {_milliseconds(c.value)} after every switch"
    return f"leads the model by {_milliseconds(c.value)}"


def _ringing(c: Component) -> str:
    where = "" if not c.detail else f" at {c.detail['frequency_hz']:.2g} Hz"
    return f"swings differently{where} after every switch, by {c.value:.2g} in sin θ at first"


def _rise_against_fall(c: Component) -> str:
    slow, fast = ("bending away", "coming back") if c.value > 0 else ("coming back", "bending away")
    return f"lags {_milliseconds(c.value)} more when {slow} than when {fast}"


def _upper_against_lower(c: Component) -> str:
    if abs(c.value) > _OUT_OF_PROPORTION:
        return f"bends many times {'more' if c.value > 0 else 'less'} to the lower than to the upper side"
    return (
        f"bends {_percent(c.value)} {'more' if c.value > 0 else 'less'} to the lower than to the upper side"
    )


def _gain_drift(c: Component) -> str:
    if abs(c.value) > _OUT_OF_PROPORTION:
        return f"{'grows' if c.value > 0 else 'fades'} many times over within a second against the model"
    return f"{'grows' if c.value > 0 else 'fades'} by {_percent(c.value)} per second against the model"


def _offset_drift(c: Component) -> str:
    return (
        f"wanders to the {'upper' if c.value > 0 else 'lower'} side by {abs(c.value):.2g} in sin θ per second"
    )


def _swing_frequency(c: Component) -> str:
    text = f"swings {_percent(c.value)} {'faster' if c.value > 0 else 'slower'} than the model"
    if c.detail and "measured_hz" in c.detail:
        text += f" ({c.detail['measured_hz']:.3g} Hz against {c.detail['simulated_hz']:.3g} Hz)"
    return text


def _swing_decay(c: Component) -> str:
    text = f"dies out {'faster' if c.value > 0 else 'slower'} than the model by {abs(c.value):.2g} 1/s"
    if c.detail and "measured_damping_ratio" in c.detail:
        text += (
            f" (damping ratio {round(c.detail['measured_damping_ratio'], 3):g} "
            f"against {round(max(c.detail['simulated_damping_ratio'], 0.0), 3):g})"
        )
    return text


_WORDS: dict[Kind, Callable[[Component], str]] = {
    Kind.OFFSET: _offset,
    Kind.GAIN: _gain,
    Kind.LAG: _lag,
    Kind.RINGING: _ringing,
    Kind.RISE_AGAINST_FALL: _rise_against_fall,
    Kind.UPPER_AGAINST_LOWER: _upper_against_lower,
    Kind.GAIN_DRIFT: _gain_drift,
    Kind.OFFSET_DRIFT: _offset_drift,
    Kind.SWING_FREQUENCY: _swing_frequency,
    Kind.SWING_DECAY: _swing_decay,
}


def words(component: Component) -> str:
    """A component as a predicate, without full stop: "lags 35 ms after every switch"."""
    return _WORDS[component.kind](component)


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

    def to_json(self) -> dict:
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
