"""The error by voltage and by frequency."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hasel_sysid.where_it_fails.run_series import RunSeries


@dataclass(frozen=True)
class ConditionError:
    """condition: voltage [V] or frequency [Hz]; runs: how many; mean_absolute_error of sin theta, offsets removed."""

    condition: float
    runs: int
    mean_absolute_error: float


def _by(runs: Sequence[RunSeries], conditions: Sequence[float]) -> tuple[ConditionError, ...]:
    rows = []
    for condition in sorted(set(conditions)):
        errors = [np.abs(r.residual) for r, own in zip(runs, conditions, strict=True) if own == condition]
        rows.append(ConditionError(condition, len(errors), float(np.concatenate(errors).mean())))
    return tuple(rows)


def error_by_voltage(runs: Sequence[RunSeries]) -> tuple[ConditionError, ...]:
    """Mean |Δ sin θ| for every voltage [V], rounded to 1 V; a passive run is at 0 V."""
    return _by(runs, [round(run.voltage) for run in runs])


def error_by_frequency(runs: Sequence[RunSeries]) -> tuple[ConditionError, ...]:
    """Mean |Δ sin θ| for every frequency [Hz], rounded to two digits; 0 where the drive does not repeat."""
    return _by(runs, [float(f"{run.frequency:.2g}") for run in runs])
