# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A model against all recordings: every run is simulated, and what is different is collected."""

from collections.abc import Sequence
from concurrent.futures import Executor, as_completed
from dataclasses import dataclass
from typing import Any

import numpy as np
from hasel_common.progress import Workload
from hasel_sim.model import Model
from hasel_sim.parallel import submit_all
from hasel_sim.run import Simulation

from hasel_sysid.data_quality import DataFinding, check_against_model, check_recording
from hasel_sysid.dataset import prepared
from hasel_sysid.errors import SysidError
from hasel_sysid.expected_work import work_of
from hasel_sysid.experiment import Experiment
from hasel_sysid.residual_analysis.analysis import RunAnalysis, WhereItFails, where_it_fails
from hasel_sysid.residual_analysis.run_series import RunSeries, run_series
from hasel_sysid.swimming_speed import SwimmingSpeed, swimming_speed


@dataclass(frozen=True)
class ConditionError:
    """condition: its number; label: with its unit, such as "5500 V"; runs: how many; mean_absolute_error of sin theta,
    offsets removed.
    """

    condition: float
    label: str
    runs: int
    mean_absolute_error: float


def _errors_by(
    runs: Sequence[RunSeries], conditions: Sequence[tuple[float, str]]
) -> tuple[ConditionError, ...]:
    rows = []
    for condition, label in sorted(set(conditions)):
        alike = [r for r, own in zip(runs, conditions, strict=True) if own == (condition, label)]
        error = float(np.concatenate([np.abs(run.residual) for run in alike]).mean())
        rows.append(ConditionError(condition, label, len(alike), error))
    return tuple(rows)


def error_by_level(runs: Sequence[RunSeries]) -> tuple[ConditionError, ...]:
    """Mean |Δ sin θ| for every level of the drive, rounded to four digits; a passive run is at 0."""
    return _errors_by(runs, [(float(f"{run.level:.4g}"), run.level_text) for run in runs])


def error_by_frequency(runs: Sequence[RunSeries]) -> tuple[ConditionError, ...]:
    """Mean |Δ sin θ| for every frequency [Hz], rounded to two digits; 0 where the drive does not repeat."""
    found = [float(f"{run.frequency:.2g}") for run in runs]
    return _errors_by(
        runs, [(frequency, f"{frequency:g} Hz" if frequency else "does not repeat") for frequency in found]
    )


@dataclass(frozen=True)
class RunComparison:
    """series: what was compared, frame by frame; unseen: not used for fitting; analysis: where it fails.

    speed: of a body that swims and whose markers were recorded, else None.
    """

    series: RunSeries
    unseen: bool
    analysis: RunAnalysis
    speed: SwimmingSpeed | None = None

    @property
    def name(self) -> str:
        """Name of the recording."""
        return self.series.name

    @property
    def mean_absolute_error(self) -> float:
        """Mean |Δ sin θ|, the run's offset taken out."""
        return float(np.abs(self.series.residual).mean())

    @property
    def mean_absolute_error_raw(self) -> float:
        """Mean |Δ sin θ| with the offset left in."""
        return float(np.abs(self.series.measured - self.series.simulated).mean())

    @property
    def fit_percent(self) -> float:
        """100 (1 - |measured - simulated| / |measured - its mean|), offset taken out; 100 is a perfect model."""
        spread = float(np.linalg.norm(self.series.measured - self.series.measured.mean()))
        return (
            100.0 * (1.0 - float(np.linalg.norm(self.series.residual)) / spread)
            if spread > 0
            else float("nan")
        )

    def to_json(self) -> dict[str, Any]:
        """Plain numbers and words."""
        return {
            "name": self.name,
            "unseen": self.unseen,
            "drive": self.series.levels,
            "frequency": self.series.frequency,
            "frames": len(self.series.time),
            "mae": self.mean_absolute_error,
            "mae_raw": self.mean_absolute_error_raw,
            "offset": self.series.offset,
            "fit_percent": self.fit_percent,
            "noise": self.analysis.noise,
            "failures": [failure.to_json() for failure in self.analysis.failures],
            **self._speeds(),
        }

    def _speeds(self) -> dict[str, float]:
        if self.speed is None:
            return {}
        return {
            "speed_m_per_s": self.speed.measured,
            "simulated_speed_m_per_s": self.speed.simulated,
            "speed_error_m_per_s": self.speed.error,
        }

    def __str__(self) -> str:
        return (
            f"{self.name}: mean |Δ sin θ| = {self.mean_absolute_error:.5f} "
            f"({self.mean_absolute_error_raw:.5f} with the offset), fit {self.fit_percent:.1f} %."
        )

    __repr__ = __str__


def _mean_error(runs: Sequence[RunComparison]) -> float | None:
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
        return _mean_error([run for run in self.runs if not run.unseen])

    @property
    def mean_absolute_error_unseen(self) -> float | None:
        """The same over the unseen runs."""
        return _mean_error([run for run in self.runs if run.unseen])

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

    def to_json(self) -> dict[str, Any]:
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


def _row(row: ConditionError, key: str) -> dict[str, Any]:
    return {key: row.condition, "label": row.label, "runs": row.runs, "mae": row.mean_absolute_error}


def compare(
    model: Model,
    experiments: Sequence[Experiment],
    pool: Executor,
    unseen: Sequence[Experiment] = (),
    label: str | None = None,
    workload: Workload | None = None,
) -> Comparison:
    """Simulate all experiments and the unseen ones with one model.

    A model without amplitudes gets its start values; one that has some keeps them, so that unseen levels are
    interpolated. label: what to call the model (default: its name); workload: counts the simulations.
    Raises SysidError for runs the body cannot have, SimulationError when the motion cannot be followed.
    """
    every = [*experiments, *unseen]
    if not every:
        raise SysidError("no recording was given; expected at least one: name .csv or .mcap files")
    model = with_amplitudes(model, every)
    simulations = _simulate(model, every, pool, workload)
    return comparison_of(model, experiments, simulations, unseen, label)


def with_amplitudes(model: Model, experiments: Sequence[Experiment]) -> Model:
    """The model itself when it has amplitudes, else with one for every voltage of the experiments."""
    started = prepared(model, experiments)
    return model if len(model.levels) else started


def comparison_of(
    model: Model,
    experiments: Sequence[Experiment],
    simulations: Sequence[Simulation],
    unseen: Sequence[Experiment] = (),
    label: str | None = None,
) -> Comparison:
    """Compare what has been simulated already; the simulations of the unseen experiments come last."""
    every = [*experiments, *unseen]
    series = [series_of(e, s) for e, s in zip(every, simulations, strict=True)]
    where = where_it_fails(series)
    seen = len(experiments)
    free = swims_freely(model)
    speeds = [
        swimming_speed(e.recording, simulation, s.cycle.period if s.cycle else None, free)
        for e, simulation, s in zip(every, simulations, series, strict=True)
    ]
    runs = tuple(
        RunComparison(s, n >= seen, a, speed)
        for n, (s, a, speed) in enumerate(zip(series, where.runs, speeds, strict=True))
    )
    set_up = []
    for experiment, simulation in zip(every, simulations, strict=True):
        recording = experiment.recording
        set_up += check_recording(recording)
        set_up += check_against_model(recording, simulation.sin_theta, simulation.markers)
    return Comparison(label or model.name, model, runs, where, tuple(set_up))


def swims_freely(model: Model) -> bool:
    """Whether the body is in a fluid and nothing holds it or its head marker, so that its way can be compared too."""
    described = model.description
    held = described.body.clamped or described.markers["head"].fixed
    return described.medium is not None and not held


def series_of(experiment: Experiment, simulation: Simulation) -> RunSeries:
    """Measured and simulated angle of one run. Raises SysidError when they have no frame in common."""
    schedule = experiment.run.schedule
    drive = None if schedule is None else (schedule.time, schedule.signal)
    series = run_series(
        experiment.name,
        experiment.run.time,
        experiment.sin_theta,
        simulation.sin_theta,
        drive,
        experiment.recording.channels,
    )
    if len(series.time) == 0:
        raise SysidError(
            f"{experiment.name} has no frame with both a measured and a simulated angle; "
            "check its time column and initial_time_s"
        )
    return series


def _simulate(
    model: Model, experiments: Sequence[Experiment], pool: Executor, workload: Workload | None
) -> list[Simulation]:
    futures = submit_all(pool, model, [experiment.run for experiment in experiments])
    if workload:
        for future in as_completed(futures):
            workload.did(work_of(model, [experiments[futures.index(future)].run]))
            workload.check()
    return [future.result() for future in futures]
