# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The muscle section of a model file: a law of how far a voltage contracts, in place of a table of amplitudes."""

from typing import Annotated, Literal

from pydantic import Field, model_validator

from hasel_sim.errors import ModelError
from hasel_sim.model.sections import Finite, Name, Positive, Section
from hasel_sim.muscle.effect import find_muscle_effects
from hasel_sim.muscle.muscle import Muscle
from hasel_sim.muscle.pouch import Pouch
from hasel_sim.parameter import Parameter


class PouchSection(Section):
    """`count` pouches in series, each `width_m` across; lengths along the muscle are those of the flat film.

    fill: liquid by that with which the free part is just a cylinder when the whole electrode is zipped.
    """

    count: Annotated[int, Field(ge=1)]
    film_length_m: Positive
    electrode_length_m: Positive
    width_m: Positive
    film_thickness_m: Positive
    relative_permittivity: Annotated[float, Field(ge=1.0, le=100.0)]
    fill: Positive = 1.0

    @property
    def pouch(self) -> Pouch:
        """One of them. Raises ModelError where the lengths do not fit together."""
        keys = [key for key in type(self).model_fields if key != "count"]
        return Pouch(**{key.removesuffix("_m"): getattr(self, key) for key in keys})


STIFFNESS, PRELOAD, GAIN = "muscle.stiffness", "muscle.preload", "muscle.gain"


class MuscleLaw(Section):
    """Every muscle that a voltage drives contracts as this Peano-HASEL does against an elastic body.

    The contraction e solves F(V, e) = preload + stiffness e; the fibres' contraction is gain times e. effects: values
    by effect and parameter of the muscle's bench, those in time left out; file: a muscle file in place of both.
    """

    law: Literal["peano_hasel"]
    pouch: PouchSection | None = None
    effects: dict[Name, dict[Name, Finite]] = Field(default_factory=dict)
    file: str | None = None

    @model_validator(mode="after")
    def _whole(self) -> "MuscleLaw":
        if (self.pouch is None) == (self.file is None):
            raise ValueError("expected either pouch or file, a muscle file: give one of the two")
        if self.file is not None and self.effects:
            raise ValueError("effects stand beside file; expected them in that muscle file: move them there")
        try:
            if self.pouch is not None:
                self.muscle()
        except ModelError as error:
            raise ValueError(str(error)) from None
        return self

    def muscle(self) -> Muscle:
        """The muscle that it speaks of. Raises ModelError for effects or lengths that cannot be."""
        if self.pouch is None:
            raise ModelError(
                f"muscle.file is still '{self.file}'; expected its pouch: read the model with load_model"
            )
        find_muscle_effects(tuple(self.effects))
        muscle = Muscle("muscle", self.pouch.pouch, self.pouch.count).with_effects(*self.effects)
        given = {f"{effect}.{key}": v for effect, values in self.effects.items() for key, v in values.items()}
        return muscle.with_values(given)


def law_parameters() -> dict[str, Parameter]:
    """What the law leaves open: pretension, the body's stiffness (0 unless freed), and how the fibres take it.

    Pretension and stiffness are hard to tell apart by the contraction at a few voltages, so that one of them is free.
    """
    every = (
        Parameter(PRELOAD, 1.0, "N", 0.01, 100.0),
        Parameter(STIFFNESS, 0.0, "N", 0.0, 1000.0, free=False),
        Parameter(GAIN, 0.5, "1", 0.05, 10.0),
    )
    return {parameter.name: parameter for parameter in every}
