"""What scipy's least squares asks of a model, and where it is near enough to the end."""

from collections.abc import Callable

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.estimation.independent import independent_share
from hasel_sysid.estimation.opening import is_close
from hasel_sysid.estimation.pace import Pace
from hasel_sysid.problem import Evaluation, Problem

Progress = Callable[[str, float], None]
"""Called with a line of text and the share done, 0 to 1."""

_KEPT = 0.25
"""Share of its promise that the last step of a search must have given (scipy's)."""
_LEAST_SHARE = 1 / 30
"""Of independent squares that a rough search reckons with: a step that gives 0.3 % is worth the next."""


class EnoughError(Exception):
    """Ends scipy's search, whose callback is not in every version that is in use."""

    def __init__(self, evaluation: Evaluation) -> None:
        super().__init__()
        self.evaluation = evaluation


class AskedModel:
    """A model that is evaluated where scipy asks, once per point; one that cannot be simulated counts as a bad one."""

    def __init__(
        self,
        problem: Problem,
        model: Model,
        names: tuple[str, ...],
        progress: Progress | None,
        most: int,
        rough: float,
        against: float = 0.0,
    ) -> None:
        """names: of the parameters that scipy moves; most: evaluations, of which progress tells the share; rough:
        relative change of independent squares at which the search is near enough, 0 for the end itself; against: as of
        `Pace`.
        """
        self.problem, self.model, self.names = problem, model, names
        self.progress, self.most, self.count = progress, most, 0
        self.rough, self._pace = rough, Pace(against, most)
        self._before: tuple[np.ndarray, Evaluation] | None = None
        self._known: dict[bytes, Evaluation] = {}
        self._first: Evaluation | None = None

    def at(self, x: np.ndarray) -> Evaluation:
        """With the parameters [n] at these values."""
        key = x.tobytes()
        if key not in self._known:
            values = dict(zip(self.names, x, strict=True))
            self._known[key] = self.problem.evaluate(self.model.with_values(values), self.names)
            self._first = self._first or self._known[key]
            self.count += 1
            if self.progress:
                error = self._known[key].mean_absolute_error
                self.progress(f"fit, step {self.count}: mean |Δ sin θ| = {error:.5f}", self.count / self.most)
        return self._known[key]

    def residual(self, x: np.ndarray) -> np.ndarray:
        """What is left there, [frames]."""
        try:
            return self.at(x).residual
        except SimulationError:
            return np.full_like(self._first.residual, 1.0)

    def jacobian(self, x: np.ndarray) -> np.ndarray:
        """Derivatives of what is left, [frames, n]; asked for where a step was taken, and there only.

        Raises EnoughError where that step was not worth another one, or leads nowhere near another model.
        """
        here = self.at(x)
        if self._pace.leads_nowhere(here.sum_of_squares, self.count):
            raise EnoughError(here)
        if self.rough and self._before is not None and self._is_near_enough(*self._before, x, here):
            raise EnoughError(here)
        self._before = x, here
        return -here.jacobian

    def _is_near_enough(self, x0: np.ndarray, before: Evaluation, x1: np.ndarray, here: Evaluation) -> bool:
        """As scipy ends: by a step that gave little, and not because it was held back by a model that fits badly.

        Of a model that is far off, small steps do not tell how far they will lead.
        """
        gain = before.sum_of_squares - here.sum_of_squares
        foretold = before.residual - before.jacobian @ (x1 - x0)
        kept = gain > _KEPT * (before.sum_of_squares - float(foretold @ foretold))
        share = max(independent_share(here.residual, here.runs), _LEAST_SHARE)
        return kept and is_close(here) and gain * share < self.rough * before.sum_of_squares
