# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The simulator that plays the measured swimmer: other mesh, time step and muscle law than the model's."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.model import Model, load_model
from hasel_sim.parameter import value_with_error

from hasel_bringup.hidden_truth.hidden import NOTHING, hidden_values, with_hidden

_LAW_VOLTAGES = np.arange(250.0, 6001.0, 250.0)
"""[V]; dense enough that interpolation between them does not matter."""


@dataclass(frozen=True)
class TruthNumerics:
    """Discretisation of the truth; `model` names what it must differ from."""

    name: str
    mesh_density: float
    layers: int
    steps_per_second: float = 960.0
    spectral_radius: float = 0.8

    def applied(self, model: Model) -> Model:
        """The model on this discretisation."""
        return model.with_numerics(
            mesh_density=self.mesh_density,
            layers=self.layers,
            steps_per_second=self.steps_per_second,
            spectral_radius=self.spectral_radius,
        )


NUMERICS = {
    n.name: n
    for n in (
        TruthNumerics("near", 1.6, 2),
        TruthNumerics("coarse", 0.6, 1),
        TruthNumerics("converged", 3.0, 3, spectral_radius=0.9),
    )
}
"""What the fitted model leaves of noise-free runs with nothing hidden, as a share of the noise's rms: 7 % for `near`,
39 % for `coarse`, 8 % for `converged`."""
_LIVE = TruthNumerics("live", 1.6, 2, steps_per_second=480.0)  # the model: 1.0, 1 and 240


@dataclass(frozen=True)
class Muscles:
    """Contraction = largest x^n / (1 + x^n), x = voltage / half_voltage: saturating, smooth; slope [1/s]."""

    largest: float
    half_voltage: float
    exponent: float
    slope: float

    def contraction(self, voltage: np.ndarray) -> np.ndarray:
        """Contraction [1] aimed at for voltages [V]."""
        x = (voltage / self.half_voltage) ** self.exponent
        return self.largest * x / (1 + x)


NOMINAL = Muscles(largest=0.1815, half_voltage=7232.0, exponent=2.4, slope=0.26)
"""Contractions of 0.027, 0.044 and 0.062 at 3.5, 4.5 and 5.5 kV."""


def draw_muscles(generator: np.random.Generator) -> Muscles:
    """The nominal muscles with stroke and slope up to 15 % off, and a law of up to 5 % other shape."""
    stroke, slope = generator.uniform(0.85, 1.15, 2)
    half, exponent = generator.uniform(0.95, 1.05, 2)
    shape = Muscles(1.0, NOMINAL.half_voltage * half, NOMINAL.exponent * exponent, 1.0)
    at = np.array([4500.0])
    largest = stroke * float(NOMINAL.contraction(at)[0] / shape.contraction(at)[0])
    return Muscles(largest, shape.half_voltage, shape.exponent, NOMINAL.slope * slope)


def truth_model(
    numerics: TruthNumerics, muscles: Muscles, effects: dict[str, dict[str, float]] | None = None
) -> Model:
    """The swimmer with these muscles and hidden effects (id or path/to/file.py:Class -> value by parameter name)."""
    model = numerics.applied(load_model("swimmer")).with_levels(_LAW_VOLTAGES)
    contraction = muscles.contraction(_LAW_VOLTAGES)
    values = {f"amplitude_{v:g}": a for v, a in zip(_LAW_VOLTAGES, contraction, strict=True)}
    model = model.with_values({**values, "slope": muscles.slope})
    for name, chosen in (effects or {}).items():
        model = model.with_effects(name)
        identity = model.effects[-1].id
        model = model.with_values({f"{identity}.{parameter}": value for parameter, value in chosen.items()})
    return model


@dataclass(frozen=True)
class Secret:
    """What the virtual swimmer has beyond the model; nobody is told before the end.

    values: by the name of their parameter; muscles and numerics: of the truth, other than the model's."""

    values: Mapping[str, float]
    muscles: Muscles
    numerics: TruthNumerics

    def model(self) -> Model:
        """The swimmer that the camera sees. Raises ModelError for a value that it cannot have."""
        return with_hidden(truth_model(self.numerics, self.muscles), self.values)

    def __str__(self) -> str:
        model = self.model()
        parts = [
            f"{name} = {value_with_error(value, None, model.parameter(name).unit)}"
            for name, value in self.values.items()
        ]
        return ", ".join(parts) or NOTHING


def draw_secret(hidden: Sequence[str], generator: np.random.Generator) -> Secret:
    """A swimmer with what `hidden` says, and muscles of its own. Raises BringupError for a word that says nothing."""
    return Secret(hidden_values(hidden, generator), draw_muscles(generator), _LIVE)
