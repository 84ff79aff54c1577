"""What scipy's least squares asks of a model, and where it is near enough to the end."""

from collections.abc import Callable
from functools import partial

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.estimation.bounded import bounded_change
from hasel_sysid.estimation.independent import independent_share
from hasel_sysid.estimation.opening import is_close
from hasel_sysid.estimation.pace import Pace
from hasel_sysid.problem import Evaluation, Problem

Progress = Callable[[str, float], None]
"""Called with a line of text and the share done, 0 to 1."""

_KEPT = 0.25
"""Share of its promise that the last step of a search must have given (scipy's)."""
_ROUND_OFF = 1e-9
"""By how much a point may differ from the start, in units of the scales, and be the start: scipy moves what begins on a
bound a little away from it."""
_LEAST_SHARE = 1 / 30
"""Of independent squares that a rough search reckons with: a step that gives 0.3 % is worth the next."""


class EnoughError(Exception):
    """Ends scipy's search, whose callback is not in every version that is in use."""

    def __init__(self, evaluation: Evaluation) -> None:
        super().__init__()
        self.evaluation = evaluation


class AskedModel:
    """A model that is evaluated where scipy asks, once per point; one that cannot be simulated counts as a bad one.

    Points are in units of the parameters' scales.
    """

    def __init__(
        self,
        problem: Problem,
        model: Model,
        names: tuple[str, ...],
        scale: np.ndarray,
        progress: Progress | None,
        most: int,
        rough: float,
        goal: float = 0.0,
    ) -> None:
        """names: of the parameters that scipy moves; scale: of each, [names]; most: evaluations, of which progress
        tells the share; rough: relative change of independent squares at which the search is near enough, 0 for the end
        itself; goal: as of `Pace`.
        """
        self.problem, self.model, self.names, self.scale = problem, model, names, scale
        self.progress, self.most, self.count = progress, most, 0
        self.rough, self._pace = rough, Pace(goal, most)
        ranges = [(model.parameters[name].lower, model.parameters[name].upper) for name in names]
        self._bounds = np.reshape(ranges, (-1, 2)).T
        self._before: tuple[np.ndarray, Evaluation] | None = None
        self._known: dict[bytes, Evaluation] = {}
        self._start: tuple[np.ndarray, Evaluation] | None = None

    def begin(self, z: np.ndarray, known: Evaluation | None = None) -> None:
        """At a point; known: what the model leaves there, if it was evaluated. Raises SimulationError."""
        self._start = z, known or self._evaluated(z)

    def at(self, z: np.ndarray) -> Evaluation:
        """At a point [names]."""
        begun, first = self._start
        if np.abs(z - begun).max(initial=0.0) <= _ROUND_OFF:
            return first
        key = z.tobytes()
        if key not in self._known:
            self._known[key] = self._evaluated(z)
        return self._known[key]

    def _evaluated(self, z: np.ndarray) -> Evaluation:
        values = dict(zip(self.names, np.clip(z * self.scale, *self._bounds), strict=True))
        found = self.problem.evaluate(self.model.with_values(values), self.names)
        self.count += 1
        if self.progress:
            error = found.mean_absolute_error
            self.progress(f"fit, step {self.count}: mean |Δ sin θ| = {error:.5f}", self.count / self.most)
        return found

    def residual(self, z: np.ndarray) -> np.ndarray:
        """What is left there, [frames]."""
        try:
            return self.at(z).residual
        except SimulationError:
            return np.full_like(self._start[1].residual, 1.0)

    def jacobian(self, z: np.ndarray) -> np.ndarray:
        """Derivatives of what is left, [frames, n]; asked for where a step was taken, and there only.

        Raises EnoughError where that step was not worth another one, or does not lead to the goal.
        """
        here = self.at(z)
        if self._pace.leads_nowhere(here.sum_of_squares, self.count, partial(self._foretold, here)):
            raise EnoughError(here)
        if self.rough and self._before is not None and self._is_near_enough(*self._before, z, here):
            raise EnoughError(here)
        self._before = z, here
        return -here.jacobian * self.scale

    def _foretold(self, here: Evaluation) -> float:
        """Squares after the whole next step, to first order, which tells nothing of a model that is far off."""
        if not is_close(here):
            return 0.0
        values = np.array([here.model.values[name] for name in self.names])
        return bounded_change(here.residual, here.jacobian, *(self._bounds - values))[1]

    def _is_near_enough(self, z0: np.ndarray, before: Evaluation, z1: np.ndarray, here: Evaluation) -> bool:
        """As scipy ends: by a step that gave little, and not because it was held back by a model that fits badly.

        Of a model that is far off, small steps do not tell how far they will lead.
        """
        gain = before.sum_of_squares - here.sum_of_squares
        foretold = before.residual - before.jacobian @ ((z1 - z0) * self.scale)
        kept = gain > _KEPT * (before.sum_of_squares - float(foretold @ foretold))
        share = max(independent_share(here.residual, here.runs), _LEAST_SHARE)
        return kept and is_close(here) and gain * share < self.rough * before.sum_of_squares
