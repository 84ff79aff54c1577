"""Constancy: whether one value of an effect does for every voltage and frequency, as it must if its law is right."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.run import Simulation

from hasel_sysid.estimation.covariance import (
    parameter_covariance,
    seen_directions,
    wider_where_runs_disagree,
)
from hasel_sysid.estimation.fit import FittedModel
from hasel_sysid.noise.model import NoiseModel
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Evaluation
from hasel_sysid.where_it_fails.drive_cycle import drive_cycle

_ONE_CONDITION = 1.05


@dataclass(frozen=True)
class ParameterTrend:
    """What a parameter would have to be at both ends of a range of runs, were it free to change in between.

    condition: level of the drive or frequency; ends: of the range; values: at the ends, in the parameter's own unit;
    standard_error: of their difference; unit: of the condition.
    """

    parameter: str
    condition: str
    ends: tuple[float, float]
    values: tuple[float, float]
    standard_error: float
    unit: str

    @property
    def contradicts(self) -> bool:
        """Whether the values differ beyond doubt, and by as much as matters."""
        difference = abs(self.values[1] - self.values[0])
        certain, matters = 2 * POLICY.confidence, 2 * POLICY.matters
        return difference > max(certain * self.standard_error, matters * abs(np.mean(self.values)))

    def __str__(self) -> str:
        unit = self.unit
        (low, high), (first, last) = self.ends, self.values
        return (
            f"{self.parameter} would have to be {first:.3g} at {low:.4g} {unit} and {last:.3g} at {high:.4g} {unit}: "
            "something like it is at work, but not by this law."
        )


def against_law(fit: FittedModel, noise: NoiseModel, effects: Sequence[str]) -> list[ParameterTrend]:
    """What speaks against these effects of a fitted model being laws."""
    return [trend for trend in trends(fit, noise, effects) if trend.contradicts]


def trends(fit: FittedModel, noise: NoiseModel, effects: Sequence[str]) -> list[ParameterTrend]:
    """Trends of the effects' fitted sizes with level and frequency of the drive; time constants are left out.

    Linear in the logarithm of the condition, to first order in the change; conditions that do not vary are left out.
    What stands on a bound stays there: beyond it there is no law, and nothing to be constant. A trend that finer
    numerics would bring is that of mesh or time step: one standard error, as in `with_numerical_error`.
    """
    sizes = {
        f"{effect.id}.{p.name}"
        for effect in fit.model.effects
        if effect.id in effects
        for p in effect.parameters
        if not p.scan
    }
    inside = fit.evaluation.by([name for name in fit.evaluation.names if name not in fit.at_bound])
    names = [name for name in inside.names if name in sizes and name not in fit.undetermined]
    numerical = list(fit.changes_by_refinement.values())
    found = []
    for condition, values in conditions(fit.evaluation.simulations).items():
        if np.isfinite(values).all() and values.max() > _ONE_CONDITION * values.min():
            unit = "Hz" if condition == "frequency" else fit.model.drive_unit
            found += [_trend(inside, noise, name, condition, values, unit, numerical) for name in names]
    return found


def _trend(
    evaluation: Evaluation,
    noise: NoiseModel,
    name: str,
    condition: str,
    values: np.ndarray,
    unit: str,
    numerical: Sequence[np.ndarray],
) -> ParameterTrend:
    """values: the condition of every run; numerical: changes of the series [frames] by finer numerics."""
    of_run = np.log(values / np.exp(np.log(values).mean()))
    own = evaluation.jacobian[:, evaluation.names.index(name)]
    columns = np.column_stack([evaluation.jacobian, own * of_run[evaluation.runs]])
    scale = np.linalg.norm(columns, axis=0)
    scale[scale == 0] = 1.0
    change = np.linalg.lstsq(columns / scale, evaluation.residual, rcond=1e-7)[0] / scale
    covariance, _ = parameter_covariance(columns, noise, evaluation.series)
    # what else is wrong in some runs must not pass for a trend of this effect
    left = evaluation.residual - columns @ change
    errors = wider_where_runs_disagree(np.sqrt(np.diag(covariance)), columns, left, evaluation.runs)
    seen = seen_directions(columns)
    by_numerics = [seen.estimate(change)[-1] for change in numerical]
    middle = evaluation.model.values[name] + change[evaluation.names.index(name)]
    low, high = float(of_run.min()), float(of_run.max())
    return ParameterTrend(
        name,
        condition,
        (float(values.min()), float(values.max())),
        (float(middle + change[-1] * low), float(middle + change[-1] * high)),
        float((high - low) * np.linalg.norm([errors[-1], *by_numerics])),
        unit,
    )


def conditions(simulations: Sequence[Simulation]) -> dict[str, np.ndarray]:
    """Largest level and frequency of the drive [Hz] of every run, [runs]; NaN where there is none."""
    return {
        "level": np.array([_peak(s) for s in simulations]),
        "frequency": np.array([_frequency(s) for s in simulations]),
    }


def _peak(simulation: Simulation) -> float:
    schedule = simulation.run.schedule
    peak = 0.0 if schedule is None else float(np.abs(schedule.signal).max(initial=0.0))
    return peak if peak > 0 else np.nan


def _frequency(simulation: Simulation) -> float:
    run = simulation.run
    if run.schedule is None or len(run.time) < 2:
        return np.nan
    cycle = drive_cycle(run.time, run.schedule.at(run.time))
    return np.nan if cycle is None else 1.0 / cycle.period
