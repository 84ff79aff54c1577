"""What `hidden` says, of every command, node and launch file: nothing, any effect, named effects, or values."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from hasel_common.names import nearest_name

from hasel_bringup.errors import BringupError

if TYPE_CHECKING:
    import numpy as np
    from hasel_sim.model import Model

RANDOM, NOTHING = "random", "none"
MEANING = (
    "what the swimmer has beyond the model: none, random, effects, or values: quadratic_drag.coefficient=0.25"
)


def hideable() -> list[str]:
    """Effects that change how the body moves: those of the observation would not show in a picture of its markers."""
    from hasel_sim.effects.base import ObservationEffect
    from hasel_sim.effects.registry import catalogue

    return [name for name, effect in catalogue().items() if not isinstance(effect, ObservationEffect)]


def check_hidden(words: Iterable[str]) -> None:
    """Raises BringupError for a word that is neither none, random, an effect that moves the body, nor name=value."""
    for word in words:
        name, separator, value = word.partition("=")
        if separator and _is_number(value):
            name = name.rpartition(".")[0]
        elif separator:
            raise BringupError(
                f"'{word}' cannot be hidden; expected a number behind '=', as in quadratic_drag.coefficient=0.25"
            )
        if name not in ("", RANDOM, NOTHING) and name not in (known := hideable()):
            raise BringupError(
                f"'{word}' cannot be hidden; expected {NOTHING}, {RANDOM}, name=value or an effect that moves the "
                f"body: "
                f"{nearest_name(name, known)}"
            )


def hidden_values(words: Sequence[str], generator: "np.random.Generator") -> dict[str, float]:
    """Values by the name of their parameter; an effect without values gets about its typical size.

    Raises BringupError for a word that says nothing.
    """
    from hasel_bringup.hidden_truth.drawn_values import draw_hidden_values

    check_hidden(words)
    values: dict[str, float] = {}
    for word in words:
        name, separator, text = word.partition("=")
        if separator:
            values[name] = float(text)
        elif name != NOTHING:
            effect = str(generator.choice(hideable())) if name == RANDOM else name
            drawn = draw_hidden_values(effect, 1.0, generator)
            values.update({f"{effect}.{parameter}": value for parameter, value in drawn.items()})
    return values


def with_hidden(model: "Model", values: Mapping[str, float]) -> "Model":
    """The model with these values; an effect named before the dot is added first.

    Raises ModelError for a parameter that is not there or a value out of its range.
    """
    from hasel_sim.errors import ModelError

    for name, value in values.items():
        effect = name.rpartition(".")[0]
        if effect and effect not in {known.id for known in model.effects}:
            model = model.with_effects(effect)
        parameter = model.parameter(name)
        if not parameter.lower <= value <= parameter.upper:
            raise ModelError(
                f"{name} = {value:g} {parameter.unit} is out of range; expected {parameter.lower:g} to "
                f"{parameter.upper:g}"
            )
        model = model.with_values({name: value})
    return model


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
