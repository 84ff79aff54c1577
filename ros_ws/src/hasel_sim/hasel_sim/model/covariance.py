"""Standard errors of parameters, and how they hang together."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from hasel_sim.model.parameter import Parameter


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
