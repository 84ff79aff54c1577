"""A model against all recordings."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.model import Model

from hasel_sysid.compare.run_comparison import RunComparison
from hasel_sysid.data_gate import DataFinding
from hasel_sysid.where_it_fails.analyse import WhereItFails
from hasel_sysid.where_it_fails.by_condition import ConditionError, error_by_frequency, error_by_level


def _error(runs: Sequence[RunComparison]) -> float | None:
    """Mean |Δ sin θ| over all frames of these runs; None without runs."""
    if not runs:
        return None
    return float(np.abs(np.concatenate([run.series.residual for run in runs])).mean())


@dataclass(frozen=True)
class Comparison:
    """label: what the model is called beside others; set_up: faults of the recordings, found before the physics."""

    label: str
    model: Model
    runs: tuple[RunComparison, ...]
    where: WhereItFails
    set_up: tuple[DataFinding, ...] = ()

    @property
    def mean_absolute_error(self) -> float | None:
        """Mean |Δ sin θ| over all frames of the runs that are not called unseen; None without any."""
        return _error([run for run in self.runs if not run.unseen])

    @property
    def mean_absolute_error_unseen(self) -> float | None:
        """The same over the unseen runs."""
        return _error([run for run in self.runs if run.unseen])

    @property
    def mean_speed_error(self) -> float | None:
        """Mean |Δ speed| [m/s] over all runs of a body that swims; None without such runs."""
        errors = [abs(run.speed.error) for run in self.runs if run.speed is not None]
        return float(np.mean(errors)) if errors else None

    @property
    def by_level(self) -> tuple[ConditionError, ...]:
        """Error for every level of the drive."""
        return error_by_level([run.series for run in self.runs])

    @property
    def by_frequency(self) -> tuple[ConditionError, ...]:
        """Error for every frequency."""
        return error_by_frequency([run.series for run in self.runs])

    def to_json(self) -> dict:
        """Everything but the series, as plain numbers and words."""
        return {
            "model": self.label,
            "effects": [effect.id for effect in self.model.effects],
            "mae_fit": self.mean_absolute_error,
            "mae_validation": self.mean_absolute_error_unseen,
            "runs": [run.to_json() for run in self.runs],
            "mean_speed_error_m_per_s": self.mean_speed_error,
            "by_level": [_row(row, "level") for row in self.by_level],
            "by_frequency": [_row(row, "frequency") for row in self.by_frequency],
            "where_it_fails": self.where.sentences(),
            "failures": [failure.to_json() for failure in self.where.failures],
            "data_gate": [finding.to_json() for finding in self.set_up],
        }

    def __str__(self) -> str:
        parts = []
        for name, error in (
            ("mean |Δ sin θ|", self.mean_absolute_error),
            ("on unseen runs", self.mean_absolute_error_unseen),
        ):
            parts += [] if error is None else [f"{name} = {error:.5f}"]
        if self.mean_speed_error is not None:
            parts += [f"mean |Δ speed| = {1e3 * self.mean_speed_error:.3g} mm/s"]
        return f"{self.label}: {', '.join(parts)}."

    __repr__ = __str__


def _row(row: ConditionError, key: str) -> dict:
    return {key: row.condition, "label": row.label, "runs": row.runs, "mae": row.mean_absolute_error}
