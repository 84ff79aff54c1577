"""One number from many runs, and whether it depends on voltage or frequency."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

_CLEAR = 3.0


@dataclass(frozen=True)
class Pooled:
    """Mean over runs of equal weight up to their errors; scatter: standard deviation between runs beyond the errors."""

    mean: float
    standard_error: float
    scatter: float


def pool(values: Sequence[float] | np.ndarray, errors: Sequence[float] | np.ndarray) -> Pooled:
    """Random-effects mean of values [n] with standard errors [n] (DerSimonian and Laird, 1986)."""
    value, variance = np.asarray(values, float), np.maximum(np.asarray(errors, float) ** 2, 1e-30)
    weight = 1.0 / variance
    fixed = float((weight * value).sum() / weight.sum())
    excess = float((weight * (value - fixed) ** 2).sum()) - (len(value) - 1)
    scale = float(weight.sum() - (weight**2).sum() / weight.sum())
    between = max(0.0, excess / scale) if scale > 0 else 0.0
    weight = 1.0 / (variance + between)
    return Pooled(float((weight * value).sum() / weight.sum()), float(weight.sum() ** -0.5), between**0.5)


@dataclass(frozen=True)
class Trend:
    """A condition (such as 3.5 Hz) in which a value is clearly larger than in the others."""

    condition: float
    value: float
    elsewhere: float


def trend(conditions: Sequence[float], values: Sequence[float], errors: Sequence[float]) -> Trend | None:
    """The condition where the value, in the direction of its mean, stands out; None when none does.

    Standing out: half as large again as elsewhere and further away than three standard errors.
    """
    condition, value, error = (np.asarray(part, float) for part in (conditions, values, errors))
    groups = {c: pool(value[condition == c], error[condition == c]) for c in np.unique(condition)}
    if len(groups) < 2:
        return None
    sign = np.sign(pool(value, error).mean) or 1.0
    most = max(groups, key=lambda c: sign * groups[c].mean)
    others = pool(value[condition != most], error[condition != most])
    difference = sign * (groups[most].mean - others.mean)
    clear = _CLEAR * np.hypot(groups[most].standard_error, others.standard_error)
    if difference > clear and difference > 0.5 * abs(others.mean):
        return Trend(float(most), groups[most].mean, others.mean)
    return None
