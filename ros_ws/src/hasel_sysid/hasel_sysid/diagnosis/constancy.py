"""Whether one value of an effect does for every voltage and frequency, as it must if its law is the right one."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hasel_sysid.diagnosis.conditions import conditions
from hasel_sysid.drive_match import drive_unit
from hasel_sysid.estimation import FitResult
from hasel_sysid.estimation.between_runs import wider_where_runs_disagree
from hasel_sysid.estimation.directions import seen_directions
from hasel_sysid.estimation.uncertainty import parameter_covariance
from hasel_sysid.noise import NoiseModel
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Evaluation

_ONE_CONDITION = 1.05


@dataclass(frozen=True)
class Trend:
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
        certain, matters = 2 * POLICY.doubt, 2 * POLICY.matters
        return difference > max(certain * self.standard_error, matters * abs(np.mean(self.values)))

    def __str__(self) -> str:
        unit = self.unit
        (low, high), (first, last) = self.ends, self.values
        return (
            f"{self.parameter} would have to be {first:.3g} at {low:.4g} {unit} and {last:.3g} at {high:.4g} {unit}: "
            "something like it is at work, but not by this law."
        )


def trends(fit: FitResult, noise: NoiseModel, effects: Sequence[str]) -> list[Trend]:
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
            unit = "Hz" if condition == "frequency" else drive_unit(fit.model)
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
) -> Trend:
    """values: the condition of every run; numerical: changes of the series [frames] by finer numerics."""
    of_run = np.log(values / np.exp(np.log(values).mean()))
    own = evaluation.jacobian[:, evaluation.names.index(name)]
    columns = np.column_stack([evaluation.jacobian, own * of_run[evaluation.runs]])
    scale = np.linalg.norm(columns, axis=0)
    scale[scale == 0] = 1.0
    change = np.linalg.lstsq(columns / scale, evaluation.residual, rcond=1e-7)[0] / scale
    covariance, _ = parameter_covariance(columns, noise, evaluation.runs)
    # what else is wrong in some runs must not pass for a trend of this effect
    left = evaluation.residual - columns @ change
    errors = wider_where_runs_disagree(np.sqrt(np.diag(covariance)), columns, left, evaluation.runs)
    seen = seen_directions(columns)
    by_numerics = [seen.estimate(change)[-1] for change in numerical]
    middle = evaluation.model.values[name] + change[evaluation.names.index(name)]
    low, high = float(of_run.min()), float(of_run.max())
    return Trend(
        name,
        condition,
        (float(values.min()), float(values.max())),
        (float(middle + change[-1] * low), float(middle + change[-1] * high)),
        float((high - low) * np.linalg.norm([errors[-1], *by_numerics])),
        unit,
    )
