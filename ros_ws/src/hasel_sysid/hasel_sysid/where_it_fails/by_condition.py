"""The error by level of the drive and by frequency."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hasel_sysid.where_it_fails.run_series import RunSeries


@dataclass(frozen=True)
class ConditionError:
    """condition: its number; label: with its unit, such as "5500 V"; runs: how many; mean_absolute_error of sin theta,
    offsets removed.
    """

    condition: float
    label: str
    runs: int
    mean_absolute_error: float


def _by(runs: Sequence[RunSeries], conditions: Sequence[tuple[float, str]]) -> tuple[ConditionError, ...]:
    rows = []
    for condition, label in sorted(set(conditions)):
        alike = [r for r, own in zip(runs, conditions, strict=True) if own == (condition, label)]
        error = float(np.concatenate([np.abs(run.residual) for run in alike]).mean())
        rows.append(ConditionError(condition, label, len(alike), error))
    return tuple(rows)


def error_by_level(runs: Sequence[RunSeries]) -> tuple[ConditionError, ...]:
    """Mean |Δ sin θ| for every level of the drive, rounded to four digits; a passive run is at 0."""
    return _by(runs, [(float(f"{run.level:.4g}"), run.level_text) for run in runs])


def error_by_frequency(runs: Sequence[RunSeries]) -> tuple[ConditionError, ...]:
    """Mean |Δ sin θ| for every frequency [Hz], rounded to two digits; 0 where the drive does not repeat."""
    found = [float(f"{run.frequency:.2g}") for run in runs]
    return _by(
        runs, [(frequency, f"{frequency:g} Hz" if frequency else "does not repeat") for frequency in found]
    )
