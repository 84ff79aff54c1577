"""A named number of a model, with unit and bounds."""

from dataclasses import dataclass, field
from math import isfinite

from hasel_sim.model.value_text import value_with_error


@dataclass(frozen=True)
class Parameter:
    """value and bounds in `unit`; free: a fit may change it; standard_error: of the last fit, None if not fitted.

    correlations: of that error with those of other parameters, by their names; each pair stands at one of its two.
    """

    name: str
    value: float
    unit: str
    lower: float
    upper: float
    free: bool = True
    standard_error: float | None = None
    correlations: dict[str, float] = field(default_factory=dict, hash=False)

    @property
    def magnitude(self) -> float:
        """What changes of it are measured by: its value, or of one at 0 a tenth of its range, 0 where that is open."""
        width = self.upper - self.lower
        return abs(self.value) or (0.1 * width if isfinite(width) else 0.0)

    def __str__(self) -> str:
        return f"{self.name} = {value_with_error(self.value, self.standard_error, self.unit)}"
