"""One model of a session, with what it says of every run and how it came about."""

from dataclasses import dataclass
from functools import cached_property

from hasel_sim.model import Model
from hasel_sim.run import Simulation
from hasel_sysid.comparison import Comparison, comparison_of
from hasel_sysid.estimation import FittedModel
from hasel_sysid.experiment import Experiment
from hasel_sysid.problem import Evaluation


@dataclass(frozen=True)
class Step:
    """label: what was done last; model; seen, unseen: it against the fitted and the unseen runs (None without such),
    with derivatives by all its free parameters; fit: of these runs, None where the values were set by hand.

    did: the lines of Python that lead here from the step before; file: its model file, empty until it is kept.
    """

    label: str
    model: Model
    experiments: tuple[Experiment, ...]
    others: tuple[Experiment, ...]
    seen: Evaluation
    unseen: Evaluation | None = None
    fit: FittedModel | None = None
    did: tuple[str, ...] = ()
    file: str = ""

    @property
    def error(self) -> float:
        """Mean |Δ sin θ| on the fitted runs."""
        return self.seen.mean_absolute_error

    @property
    def error_unseen(self) -> float | None:
        """Mean |Δ sin θ| on the unseen runs; None without any."""
        return None if self.unseen is None else self.unseen.mean_absolute_error

    @property
    def simulations(self) -> tuple[Simulation, ...]:
        """Of all runs, the unseen ones last."""
        return (*self.seen.simulations, *(() if self.unseen is None else self.unseen.simulations))

    @cached_property
    def comparison(self) -> Comparison:
        """Where it fails, run by run and in all runs."""
        return comparison_of(self.model, self.experiments, self.simulations, self.others, self.label)

    @property
    def effects(self) -> tuple[str, ...]:
        """Ids of the model's effects."""
        return tuple(effect.id for effect in self.model.effects)

    def __str__(self) -> str:
        unseen = "" if self.error_unseen is None else f", {self.error_unseen:.5f} on unseen runs"
        return f"{self.label}: mean |Δ sin θ| {self.error:.5f} on fitted runs{unseen}"
