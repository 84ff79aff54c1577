# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is asked of a model beyond how likely it is: does it describe every regime of its runs, and is it a law?

Lack of fit: the residual against the noise, by regime. Constancy: whether one value of an effect does for every voltage
and frequency, as it must if its law is right.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.run import Simulation
from scipy.special import gammaincc

from hasel_sysid.estimation.covariance import parameter_covariance, seen_directions, wider_where_runs_disagree
from hasel_sysid.estimation.fit import FittedModel
from hasel_sysid.noise import NoiseModel
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Evaluation
from hasel_sysid.projection import orthonormal
from hasel_sysid.residual_analysis.drive_cycle import drive_cycle, driven_side

_DRAWS = 400
_FEWEST_FRAMES = 8
_QUARTERS = 4
_ONE_CONDITION = 1.05


@dataclass(frozen=True)
class LackOfFit:
    """A regime in which a model does not describe its runs; times: its rms error over the allowed one."""

    regime: str
    times: float

    def __str__(self) -> str:
        return f"{self.regime} ({self.times:.1f} times)"


@dataclass(frozen=True)
class GoodnessOfFit:
    """times: mean error of all frames over the allowed one; lacking: regimes in which it fails, worst first.

    allowed: mean |Δ sin θ| that a right model may leave.
    """

    times: float
    allowed: float
    lacking: tuple[LackOfFit, ...] = ()

    @property
    def overall(self) -> bool:
        """Whether all frames together are near what is allowed."""
        return self.times <= POLICY.near_noise

    @property
    def adequate(self) -> bool:
        """Whether the model describes these runs, everywhere."""
        return self.overall and not self.lacking

    def __str__(self) -> str:
        if self.adequate:
            return f"The model describes these runs: its error is {self.times:.2f} times what is allowed for."
        where = ", ".join(map(str, self.lacking[:3]))
        where = f", most in {where}" if where else ""
        return (
            f"The model does not describe these runs yet: its error is {self.times:.3g} times the {self.allowed:.2g} "
            f"that is allowed for{where}."
        )


def goodness_of_fit(evaluation: Evaluation, allowed: NoiseModel) -> GoodnessOfFit:
    """Lack of fit against what a right model may leave, overall and per regime (Benjamini and Hochberg 1995).

    allowed: noise and discrepancy. Regimes: run, output, largest drive, frequency, side, quarter of the cycle.
    """
    basis = orthonormal(evaluation.jacobian)
    draws = allowed.sample(evaluation.series, _DRAWS, np.random.default_rng(2), evaluation.free_offset)
    draws -= basis @ (basis.T @ draws)
    squares, by_noise = evaluation.residual**2, draws**2
    found, chances = [], []
    for name, frames in regimes(evaluation):
        if frames.sum() < _FEWEST_FRAMES:
            continue
        own, expected = squares[frames].mean(), by_noise[frames].mean(axis=0)
        found.append(LackOfFit(name, float(np.sqrt(own / expected.mean()))))
        chances.append(_chance(own, expected))
    rejected = _beyond_chance(np.array(chances))
    lacking = [
        m for m, beyond in zip(found, rejected, strict=True) if beyond and m.times > POLICY.lack_of_fit
    ]
    times = evaluation.mean_absolute_error / allowed.mean_absolute
    lacking.sort(key=lambda one: -one.times)
    return GoodnessOfFit(float(times), allowed.mean_absolute, tuple(lacking))


def regimes(evaluation: Evaluation) -> Iterator[tuple[str, np.ndarray]]:
    """Name and frames of every regime; those that all frames share are left out."""
    labels = _labels(evaluation)
    for kind, values in labels.items():
        every = [v for v in dict.fromkeys(values) if v]
        if len(every) > 1:
            for value in every:
                yield f"{kind} {value}".strip(), np.array([v == value for v in values])


def _labels(evaluation: Evaluation) -> dict[str, list[str]]:
    labels: dict[str, list[str]] = {
        "run": [],
        "output": [],
        "": [],
        "frequency": [],
        "side": [],
        "part of the cycle": [],
    }
    for simulation, output, used, _ in evaluation.each_series():
        run = simulation.run
        count, time = int(used.sum()), run.time[used]
        voltage = None if run.schedule is None else run.schedule.at(time)
        cycle = None if voltage is None or count < 2 else drive_cycle(time, voltage)
        level = ""
        if run.schedule is not None:
            unit = evaluation.model.drive_unit
            level = f"{np.abs(run.schedule.signal).max(initial=0.0):.5g} {unit}"
        side = [""] * count
        if run.schedule is not None and voltage is not None:
            first, *others = run.schedule.channels
            names = {1: first, -1: " or ".join(others), 0: ""}
            side = [names[s] for s in driven_side(voltage)]
        part = [""] * count
        if cycle is not None:
            part = [f"{int(_QUARTERS * p) + 1} of {_QUARTERS}" for p in cycle.phase(time)]
        labels["run"] += [run.name] * count
        labels["output"] += [str(output + 1)] * count
        labels[""] += [level] * count
        labels["frequency"] += [f"{1 / cycle.period:.3g} Hz" if cycle else ""] * count
        labels["side"] += side
        labels["part of the cycle"] += part
    return labels


def _chance(own: float, drawn: np.ndarray) -> float:
    """Chance of a mean square of at least this size, from draws of it by noise alone.

    A scaled chi-square with the draws' mean and variance (Satterthwaite, Biometrics 2 (1946) 110): of noise that
    neighbouring frames share few are independent, and a normal tail would be too thin.
    """
    variance = float(drawn.var())
    if not variance > 0:
        return 1.0
    half_freedom = drawn.mean() ** 2 / variance
    return float(gammaincc(half_freedom, half_freedom * own / drawn.mean()))


def _beyond_chance(chance: np.ndarray) -> np.ndarray:
    """Which of many chances are too small, with few false ones among them."""
    if len(chance) == 0:
        return np.zeros(0, dtype=bool)
    order = np.argsort(chance)
    line = POLICY.level * np.arange(1, len(chance) + 1) / len(chance)
    below = np.flatnonzero(chance[order] <= line)
    rejected = np.zeros(len(chance), dtype=bool)
    if len(below):
        rejected[order[: below[-1] + 1]] = True
    return rejected


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
