"""A named number of a model, with unit and bounds."""

from dataclasses import dataclass

from hasel_sim.model.value_text import value_with_error


@dataclass(frozen=True)
class Parameter:
    """value and bounds in `unit`; free: a fit may change it; standard_error: of the last fit, None if not fitted."""

    name: str
    value: float
    unit: str
    lower: float
    upper: float
    free: bool = True
    standard_error: float | None = None

    def __str__(self) -> str:
        return f"{self.name} = {value_with_error(self.value, self.standard_error, self.unit)}"
