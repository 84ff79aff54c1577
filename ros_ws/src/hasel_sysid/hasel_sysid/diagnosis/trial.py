"""Trying an effect: Gauss-Newton steps on drafts of the model, corrected for what a draft gets wrong."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.diagnosis.candidates import Start, resized
from hasel_sysid.diagnosis.side_by_side import side_by_side
from hasel_sysid.diagnosis.step import bounded_step
from hasel_sysid.draft import draft
from hasel_sysid.estimation.opening import is_small
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.projection import drops, orthonormal

_FAR = 2.0
"""A start that makes the sum of squares this many times worse is too far off for its promise to be believed, or not."""
_HALVINGS = 2
"""How often what starts too far off is tried again from half of its size."""
_SOME_HOPE = 0.2
"""What by its change and derivatives from far off could lower the sum of squares by less than this share is not."""


@dataclass(frozen=True, eq=False)
class Trial:
    """An effect with the values reached so far.

    model: draft with the effect; residual: corrected, at `model`'s values [frames]; jacobian [frames, names]; brought:
    those of the names that the model without the effect has not, its own and what it makes the muscles show;
    predicted: sum of squares expected after the next step, to `step` (values by name); promised: by how much the effect
    could lower the sum of squares of the model without it, by its derivatives or by the change it has made so far.
    """

    start: Start
    model: Model
    names: tuple[str, ...]
    brought: tuple[str, ...]
    residual: np.ndarray
    jacobian: np.ndarray
    step: dict[str, float]
    predicted: float
    promised: float

    @property
    def sum_of_squares(self) -> float:
        """Sum of squared residuals at the model's values."""
        return float(self.residual @ self.residual)

    @property
    def is_brought(self) -> np.ndarray:
        """Which of the names [names] the effect brought."""
        return np.array([name in self.brought for name in self.names], dtype=bool)


class Trials:
    """Tries effects on drafts of a fitted model.

    fitted: the model as fitted, evaluated with its free parameters; imitable: a basis of what these imitate, [frames,
    n]; model: the draft. Its own error, the difference between the two at the fitted values, is added to every trial:
    what matters is what the effect changes. A draft that is far off (a long undamped swing, whose phase drifts), or
    whose steps are too long to follow the motion, is not used at all.
    """

    def __init__(self, problem: Problem, fitted: Evaluation) -> None:
        self.problem, self.fitted = problem, fitted
        self.imitable = orthonormal(fitted.jacobian)
        self.tried: set[str] = set()
        self.model, self.base = draft(fitted.model), fitted
        try:
            self.base = problem.evaluate(self.model, fitted.names)
        except SimulationError:
            self.model = fitted.model
        error = fitted.residual - self.base.residual
        if not is_small(error, fitted.simulated()):
            self.model, self.base = fitted.model, fitted

    def time_is_over(self) -> bool:
        """Whether what has not been tried yet is to be left out."""
        return self.problem.time_limit.is_over()

    def first(self, starts: Sequence[Start]) -> list[Trial]:
        """Every effect at its start; those that cannot be simulated there are left out, but count as tried."""
        self.tried |= {start.effect.id for start in starts}
        together = [start for start in starts if start.changes_nothing]
        alone = [(start, self.model_at(start)) for start in starts if not start.changes_nothing]
        return self._at_null(together) + self._evaluate(alone)

    def further(self, trials: Sequence[Trial]) -> list[Trial]:
        """Every trial one step on, or as it was where the step made it worse."""
        moved = self._evaluate([(t.start, t.model.with_values(t.step)) for t in trials])
        by_start = {id(trial.start): trial for trial in moved}
        result = []
        for trial in trials:
            new = by_start.get(id(trial.start))
            better = new is not None and new.sum_of_squares < trial.sum_of_squares
            result.append(new if better else _shortened(trial))
        return result

    def model_at(self, start: Start) -> Model:
        """The draft with an effect at its start."""
        return self.model.with_effects(_source(start)).with_values(start.values)

    def corrected(self, evaluation: Evaluation) -> np.ndarray:
        """What a draft leaves [frames], less its own error; the same to the last digit where nothing changes."""
        return self.fitted.residual - (self.base.residual - evaluation.residual)

    def _at_null(self, starts: Sequence[Start]) -> list[Trial]:
        """Trials of effects that change nothing where they start: a simulation with the derivatives of all that go
        together. What they may do by a time or a place is nothing, to the last digit.
        """
        rounds = side_by_side(starts)
        models = [self.model.with_effects(*map(_source, own)).with_values(_values(own)) for own in rounds]
        names = [
            (*self.fitted.names, *(name for name in self._brought(model) if name not in _idle(own)))
            for model, own in zip(models, rounds, strict=True)
        ]
        trials = []
        for own, seen in zip(rounds, self.problem.evaluate_each(models, names), strict=True):
            if isinstance(seen, SimulationError):
                trials += self._evaluate([(start, self.model_at(start)) for start in own])
                continue
            for start in own:
                model = self.model_at(start)
                brought = self._brought(model)
                by = seen.by((*self.fitted.names, *brought), _idle([start]))
                trials.append(self._trial(start, model, brought, by))
        return trials

    def _evaluate(self, models: Sequence[tuple[Start, Model]]) -> list[Trial]:
        if not models:
            return []
        brought = [self._brought(model) for _, model in models]
        names = [(*self.fitted.names, *new) for new in brought]
        found = self.problem.evaluate_each([model for _, model in models], names)
        return [
            self._trial(start, model, new, evaluation)
            for (start, model), new, evaluation in zip(models, brought, found, strict=True)
            if not isinstance(evaluation, SimulationError)
        ]

    def _brought(self, model: Model) -> tuple[str, ...]:
        """What may be fitted in a model, and could not be before."""
        return tuple(name for name in model.free if name not in self.model.parameters)

    def _trial(self, start: Start, model: Model, brought: tuple[str, ...], evaluation: Evaluation) -> Trial:
        names = evaluation.names
        change, residual = self.base.residual - evaluation.residual, self.corrected(evaluation)
        step, predicted = bounded_step(model, names, residual, evaluation.jacobian)
        own = evaluation.by(brought).jacobian
        looks = np.column_stack([change, own])
        spanned = float(drops(looks, self.imitable, self.fitted.residual))
        promised = max(spanned, self.fitted.sum_of_squares - predicted)
        return Trial(start, model, names, brought, residual, evaluation.jacobian, step, predicted, promised)


def nearer(trials: Trials, tried: Sequence[Start], found: Sequence[Trial]) -> list[Trial]:
    """Trials from half the size, or a quarter, of what could not be simulated or made the sum of squares far worse."""
    squares = trials.fitted.sum_of_squares
    every: list[Trial] = []
    for _ in range(_HALVINGS):
        done = {
            id(t.start)
            for t in found
            if t.sum_of_squares <= _FAR * squares or t.promised < _SOME_HOPE * squares
        }
        halved = [(start, resized(start, 0.5)) for start in tried if id(start) not in done]
        tried = [half for start, half in halved if half.values != start.values]
        if not tried or trials.time_is_over():
            break
        found = trials.first(tried)
        every += found
    return every


def _idle(starts: Sequence[Start]) -> set[str]:
    """Names of the times and places of effects that do nothing."""
    return {name for start in starts for name in start.values.keys() - start.nulls.keys()}


def _values(starts: Sequence[Start]) -> dict[str, float]:
    return {name: value for start in starts for name, value in start.values.items()}


def _source(start: Start) -> str:
    return start.effect.source or start.effect.id


def _shortened(trial: Trial) -> Trial:
    """Half the step, for a trial whose full step made things worse, and the three quarters that it promises of all."""
    values = trial.model.values
    half = {name: 0.5 * (values[name] + trial.step[name]) for name in trial.names}
    promised = trial.predicted + 0.25 * (trial.sum_of_squares - trial.predicted)
    return replace(trial, step=half, predicted=promised)
