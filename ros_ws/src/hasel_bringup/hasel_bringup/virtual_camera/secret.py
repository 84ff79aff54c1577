"""What the virtual swimmer has beyond the model; nobody is told before the end."""

from dataclasses import dataclass

import numpy as np
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import Model

from hasel_bringup.hidden_truth.hidden_values import draw_hidden_values
from hasel_bringup.hidden_truth.truth import Muscles, TruthNumerics, draw_muscles, truth_model
from hasel_bringup.virtual_camera.hideable import NOTHING, RANDOM, check_hidden, hideable

_NUMERICS = TruthNumerics("live", 1.6, 2, steps_per_second=480.0)  # the model: 1.0, 1 and 240


@dataclass(frozen=True)
class Secret:
    """effects: value by parameter name, by effect id; muscles and numerics: of the truth, other than the model's."""

    effects: dict[str, dict[str, float]]
    muscles: Muscles
    numerics: TruthNumerics

    def model(self) -> Model:
        """The swimmer that the camera sees."""
        return truth_model(self.numerics, self.muscles, self.effects)

    def __str__(self) -> str:
        parts = [
            f"{identity}.{name} = {value:.4g} {_unit(identity, name)}"
            for identity, values in self.effects.items()
            for name, value in values.items()
        ]
        return ", ".join(parts) or NOTHING


def draw_secret(hidden: str, generator: np.random.Generator) -> Secret:
    """A swimmer with one hidden effect of about its typical size, and muscles of its own.

    hidden: an effect's id, `random` for any that can be hidden, `none` for none. Raises BringupError for another word.
    """
    check_hidden(hidden)
    if hidden == RANDOM:
        hidden = str(generator.choice(hideable()))
    effects = () if hidden == NOTHING else (hidden,)
    generator.integers(2**31)  # so that a seed stays for the swimmer that it always stood for
    values = {effect: draw_hidden_values(effect, 1.0, generator) for effect in effects}
    return Secret(values, draw_muscles(generator), _NUMERICS)


def _unit(identity: str, name: str) -> str:
    return next(p.unit for p in catalogue()[identity].parameters if p.name == name)
