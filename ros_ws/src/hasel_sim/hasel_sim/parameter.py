# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A named number with unit, bounds and standard error, and how the errors of several hang together."""

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from types import SimpleNamespace
from typing import Any, TypeVar

import numpy as np

Own = TypeVar("Own", bound="Parametrised")


def value_with_error(value: float, error: float | None, unit: str) -> str:
    """A value with its standard error, rounded to two digits of the error: "0.0624 ± 0.0011"."""
    suffix = "" if unit == "1" else f" {unit}"
    if not math.isfinite(value):
        return "–"
    if error is None or not math.isfinite(error) or error <= 0:
        return f"{value:.4g}{suffix}"
    digits = 1 - math.floor(math.log10(error))
    if digits > 7 or digits < -3:
        return f"{value:.4g} ± {error:.2g}{suffix}"
    return f"{value:.{max(digits, 0)}f} ± {error:.{max(digits, 0)}f}{suffix}"


@dataclass(frozen=True)
class Parameter:
    """value and bounds in `unit`; free: a fit may change it; standard_error: of the last fit, None if not fitted.

    correlations: of that error with those of other parameters, by their names; each pair stands at one of its two.
    """

    name: str
    value: float
    unit: str
    lower: float = -float("inf")
    upper: float = float("inf")
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


def covariance_of(parameters: Sequence[Parameter]) -> np.ndarray:
    """Covariance [n, n] of the errors of these parameters; infinite where one has none."""
    errors = np.array([np.inf if p.standard_error is None else p.standard_error for p in parameters])
    out = np.diag(errors**2)
    for row, p in enumerate(parameters):
        for column, other in enumerate(parameters):
            between = p.correlations.get(other.name, other.correlations.get(p.name, 0.0))
            if row != column and between and np.isfinite(errors[row] * errors[column]):
                out[row, column] = between * errors[row] * errors[column]
    return out


def with_covariance(
    parameters: Mapping[str, Parameter], names: Sequence[str], covariance: np.ndarray
) -> dict[str, Parameter]:
    """The parameters, of which these have errors of this covariance [n, n], infinite where not determined."""
    errors = np.sqrt(np.diag(covariance))
    found = uncorrelated(parameters, names)
    for row, name in enumerate(names):
        known = bool(np.isfinite(errors[row]))
        beside = [column for column in range(row) if known and 0 < errors[row] * errors[column] < np.inf]
        correlations = {
            names[column]: round(float(covariance[row, column] / (errors[row] * errors[column])), 6)
            for column in beside
        }
        found[name] = replace(
            parameters[name],
            standard_error=float(errors[row]) if known else None,
            correlations={other: min(max(value, -1.0), 1.0) for other, value in correlations.items()},
        )
    return found


def uncorrelated(parameters: Mapping[str, Parameter], names: Iterable[str]) -> dict[str, Parameter]:
    """The parameters without what is known of correlations with these."""
    gone = set(names)
    return {
        name: replace(p, correlations={})
        if name in gone
        else replace(p, correlations={o: v for o, v in p.correlations.items() if o not in gone})
        if gone & set(p.correlations)
        else p
        for name, p in parameters.items()
    }


def parameters_of(effect: Any) -> dict[str, Parameter]:
    """Those of an effect, at its null values; one without a null begins in the middle of its scan."""
    return {
        f"{effect.id}.{p.name}": Parameter(
            f"{effect.id}.{p.name}", p.scan[len(p.scan) // 2] if p.scan else p.null, p.unit, p.lower, p.upper
        )
        for p in effect.parameters
    }


def values_of(effect: Any, values: Mapping[str, float]) -> SimpleNamespace:
    """Those of an effect's parameters, as its methods take them."""
    return SimpleNamespace(**{p.name: values[f"{effect.id}.{p.name}"] for p in effect.parameters})


class Parametrised:
    """Base of the frozen dataclasses that have named parameters, a model and a muscle; changed only by copying."""

    parameters: dict[str, Parameter]

    @property
    def values(self) -> dict[str, float]:
        """Value of every parameter."""
        return {name: parameter.value for name, parameter in self.parameters.items()}

    @property
    def free(self) -> tuple[str, ...]:
        """Names of the parameters that a fit may change."""
        return tuple(name for name, parameter in self.parameters.items() if parameter.free)

    def parameter(self, name: str) -> Parameter:
        """One parameter. Raises ModelError for an unknown name."""
        raise NotImplementedError

    def with_values(
        self: Own, values: Mapping[str, float], standard_errors: Mapping[str, float | None] | None = None
    ) -> Own:
        """A copy with other parameter values. Raises ModelError for an unknown name.

        standard_errors: None for a parameter that is not determined; those not named keep theirs and its correlations.
        """
        parameters = dict(self.parameters)
        for name, value in values.items():
            error = (standard_errors or {}).get(name, self.parameter(name).standard_error)
            parameters[name] = replace(self.parameter(name), value=float(value), standard_error=error)
        return replace(self, parameters=uncorrelated(parameters, standard_errors or ()))  # type: ignore[type-var]

    def with_covariance(self: Own, names: Sequence[str], covariance: np.ndarray) -> Own:
        """A copy in which the errors of these parameters have this covariance [n, n], infinite where not determined."""
        checked = [self.parameter(name).name for name in names]
        return replace(self, parameters=with_covariance(self.parameters, checked, covariance))  # type: ignore[type-var]

    def covariance(self, names: Sequence[str]) -> np.ndarray:
        """Covariance [n, n] of the errors of these parameters; infinite where one has none."""
        return covariance_of([self.parameter(name) for name in names])

    def with_held(self: Own, *names: str) -> Own:
        """A copy in which these parameters are not fitted. Raises ModelError for an unknown name."""
        held = {name: replace(self.parameter(name), free=False) for name in names}
        return replace(self, parameters={**self.parameters, **held})  # type: ignore[type-var]
