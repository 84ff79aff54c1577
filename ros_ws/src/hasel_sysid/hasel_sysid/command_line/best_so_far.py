"""A problem that remembers its best model, for when the fit is stopped by Ctrl-C."""

from collections.abc import Sequence

from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.problem import Evaluation, Problem


class BestSoFar(Problem):
    """best: the evaluation with the least sum of squares so far; None before the first."""

    best: Evaluation | None = None

    def evaluate_each(
        self, models: Sequence[Model], names: Sequence[Sequence[str]]
    ) -> list[Evaluation | SimulationError]:
        """As the problem itself does."""
        found = super().evaluate_each(models, names)
        for evaluation in found:
            if isinstance(evaluation, SimulationError):
                continue
            if self.best is None or evaluation.sum_of_squares < self.best.sum_of_squares:
                self.best = evaluation
        return found
