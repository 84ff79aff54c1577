"""What a fit found, in numbers and in sentences."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from hasel_sim.model import Model, Parameter

from hasel_sysid.problem import Evaluation


@dataclass(frozen=True)
class FitResult:
    """The fitted model and how well it is determined.

    model: with fitted values and standard errors; evaluation: at these values; at_bound: parameters on a bound;
    undetermined: parameters that these recordings do not determine; iterations: simulations of all runs;
    in_step_until: how long after its start [s] the model moves with the body, None for all frames;
    changes_by_refinement: what finer numerics do to the simulated series [frames], as far as that was looked at;
    converged: whether the fit ended by itself, not by a number of simulations.
    """

    model: Model
    evaluation: Evaluation
    at_bound: tuple[str, ...]
    undetermined: tuple[str, ...]
    iterations: int
    method: str
    in_step_until: float | None = None
    changes_by_refinement: Mapping[str, np.ndarray] = field(default_factory=dict)
    converged: bool = True

    @property
    def mean_absolute_error(self) -> float:
        """Mean |Δ sin θ| on the fitted runs."""
        return self.evaluation.mean_absolute_error

    @property
    def sentences(self) -> list[str]:
        """What a user should know about the parameters, one sentence each."""
        notes = []
        if self.in_step_until is not None:
            notes.append(
                f"The model is in step with the first {self.in_step_until:.2g} s of the runs only, to which it was "
                "fitted: something else is missing."
            )
        notes += [_at_bound(self.model.parameters[name]) for name in self.at_bound]
        notes += [f"{name} cannot be determined from these recordings." for name in self.undetermined]
        return notes

    def __str__(self) -> str:
        values = "; ".join(str(self.model.parameters[name]) for name in self.evaluation.names)
        text = f"Fitted by {self.method} to mean |Δ sin θ| = {self.mean_absolute_error:.5f}: {values}."
        return " ".join([text, *self.sentences])


def _at_bound(p: Parameter) -> str:
    side, bound = (
        ("upper", p.upper) if abs(p.value - p.upper) < abs(p.value - p.lower) else ("lower", p.lower)
    )
    if bound == 0.0:
        return f"{p.name} is at 0: these recordings ask for none of it, or something else is missing."
    unit = "" if p.unit == "1" else f" {p.unit}"
    return f"{p.name} is at its {side} bound, {bound:g}{unit}: something else is missing, or the bound is too tight."
