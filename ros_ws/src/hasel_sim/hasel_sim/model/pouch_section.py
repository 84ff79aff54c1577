"""The pouch section of a muscle file, and of a model file whose muscles follow the Peano-HASEL law."""

from typing import Annotated

from pydantic import Field

from hasel_sim.model.section import Positive, Section
from hasel_sim.muscle.pouch import Pouch


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
        return Pouch(
            film_length=self.film_length_m,
            electrode_length=self.electrode_length_m,
            width=self.width_m,
            film_thickness=self.film_thickness_m,
            relative_permittivity=self.relative_permittivity,
            fill=self.fill,
        )
