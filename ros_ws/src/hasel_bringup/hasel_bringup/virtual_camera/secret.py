"""What the virtual swimmer has beyond the model; nobody is told before the end."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.model import Model

from hasel_bringup.hidden_truth.hidden import NOTHING, hidden_values, with_hidden
from hasel_bringup.hidden_truth.truth import Muscles, TruthNumerics, draw_muscles, truth_model

_NUMERICS = TruthNumerics("live", 1.6, 2, steps_per_second=480.0)  # the model: 1.0, 1 and 240


@dataclass(frozen=True)
class Secret:
    """values: by the name of their parameter; muscles and numerics: of the truth, other than the model's."""

    values: Mapping[str, float]
    muscles: Muscles
    numerics: TruthNumerics

    def model(self) -> Model:
        """The swimmer that the camera sees. Raises ModelError for a value that it cannot have."""
        return with_hidden(truth_model(self.numerics, self.muscles), self.values)

    def __str__(self) -> str:
        model = self.model()
        parts = [f"{name} = {value:.4g} {model.parameter(name).unit}" for name, value in self.values.items()]
        return ", ".join(parts) or NOTHING


def draw_secret(hidden: Sequence[str], generator: np.random.Generator) -> Secret:
    """A swimmer with what `hidden` says, and muscles of its own. Raises BringupError for a word that says nothing."""
    return Secret(hidden_values(hidden, generator), draw_muscles(generator), _NUMERICS)
