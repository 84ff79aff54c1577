"""A named number of a model, with unit and bounds."""

from dataclasses import dataclass


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
        error = "" if self.standard_error is None else f" ± {self.standard_error:.2g}"
        unit = "" if self.unit == "1" else f" {self.unit}"
        return f"{self.name} = {self.value:.6g}{error}{unit}"
