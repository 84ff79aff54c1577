"""Full fits of sets of effects, several at once where there are processes for them."""

import math
from collections.abc import Callable, Hashable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from hasel_sim.effects.base import Effect
from hasel_sim.errors import HaselSimError, ModelError
from hasel_sim.model import Model

from hasel_sysid.diagnosis.trial import Trial
from hasel_sysid.estimation import FitResult, fit_least_squares, is_close
from hasel_sysid.estimation.least_squares import finished
from hasel_sysid.estimation.second_start import better_from
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.selection.fits_ahead import FitsAhead
from hasel_sysid.selection.held_against import HeldAgainst
from hasel_sysid.selection.known_set import known_set
from hasel_sysid.selection.sets import EffectSet, FittedSet, Prospect, Wanted
from hasel_sysid.selection.squares import squares_beyond_slack


class SetFits:
    """Fits of models with sets of these effects, from where drafts have led."""

    def __init__(
        self, problem: Problem, effects: Mapping[str, Effect], slack: np.ndarray, given: Model | None
    ) -> None:
        """slack [frames, n]: errors that every set makes; given: the model to begin again with, where a fit that began
        far off has not come close.
        """
        self._effects, self._slack, self._given = effects, slack, given
        self._ahead: FitsAhead[FittedSet | None] = FitsAhead(problem)
        self._against = HeldAgainst()

    def foresee(self, likely: Sequence[Wanted]) -> None:
        """Begin these fits where processes would wait for work."""
        self._ahead.foresee({_key(*wanted): self._begun(*wanted) for wanted in likely})

    def fit(self, effects: EffectSet, near: FittedSet, added: Sequence[Prospect]) -> FittedSet | None:
        """Least squares of the model itself, from where the drafts have led; to the end only where it may come near the
        least squares that a set was fitted to, and where effects are added, so far below those without them as matters.
        """
        found = self._ahead.done(_key(effects, near, added), self._begun(effects, near, added))
        if found:
            self._against.learn(found.squares)
        return found

    def _begun(
        self, effects: EffectSet, near: FittedSet, added: Sequence[Prospect]
    ) -> Callable[[Problem], FittedSet | None]:
        """The fit of a set, held against what is known of others and of the one that it begins with."""
        worth = self._less_than(near) if effects > near.effects else math.inf
        goal = self._against.goal(_key(effects, near, added), near.squares, worth)
        return partial(self._fit, effects, near, added, goal)

    def _less_than(self, near: FittedSet) -> float:
        """The squares below which a larger set is worth anything; what every set misses is to no effect's credit."""
        beyond = squares_beyond_slack(near.residual, near.fit.evaluation.runs, self._slack, POLICY.doubt)
        return near.squares - POLICY.matters * beyond

    def _fit(
        self,
        effects: EffectSet,
        near: FittedSet,
        added: Sequence[Prospect],
        goal: float,
        problem: Problem,
    ) -> FittedSet | None:
        base: FitResult = near.fit
        values = dict(base.model.values)
        for prospect in added:
            trial: Trial = prospect.start
            beside = near.effects == prospect.beside
            for name, value in trial.step.items():
                if name not in values:
                    values[name] = value
                elif beside and name in base.model.values:
                    values[name] += value - base.model.values[name]
        try:
            model = self._model(near.fit.model, effects, near.effects).with_values({})
            start = {name: _inside(model, name, values[name]) for name in model.free if name in values}
            fitted = partial(_fitted, problem, goal)
            found = fitted(model.with_values(start), base.evaluation if effects == near.effects else None)
            begun_close = is_close(base.evaluation)
            found = better_from(found, self._as_given(found, begun_close), fitted)
        except (HaselSimError, ModelError):
            return None
        return known_set(found, self._effects)

    def _as_given(self, fit: FitResult, begun_close: bool) -> dict[str, float]:
        """Values before any fit, where a fit that began far off has not come close, or of what nothing shows there: an
        amplitude that no muscle has the time to reach, from which no derivative leads back.

        A fit that began beside a set that is close and ended far off lacks an effect, and not its way.
        """
        if self._given is None:
            return {}
        close = begun_close or is_close(fit.evaluation)
        return {n: self._given.values[n] for n in self._given.free if not close or n in fit.undetermined}

    def _model(self, model: Model, effects: EffectSet, before: EffectSet) -> Model:
        gone, new = sorted(before - effects), sorted(effects - before)
        model = model.without_effects(*gone) if gone else model
        return model.with_effects(*(self._effects[e].source or e for e in new)) if new else model

    def finished(self, every: Sequence[FittedSet]) -> Iterator[FittedSet]:
        """The same, gone on with where a fit was broken off before it had converged."""
        self._ahead.foresee({one: partial(self._finished, one) for one in every})
        for one in every:
            yield self._ahead.done(one, partial(self._finished, one))

    def _finished(self, fitted: FittedSet, problem: Problem) -> FittedSet:
        if fitted.fit.converged or problem.time_limit.is_over():
            return fitted
        fit = finished(problem, fitted.fit, tolerance=1e-3)
        return replace(known_set(fit, self._effects), effects=fitted.effects)


def _inside(model: Model, name: str, value: float) -> float:
    p = model.parameters[name]
    return float(np.clip(value, p.lower, p.upper))


def _fitted(problem: Problem, goal: float, model: Model, begun: Evaluation | None = None) -> FitResult:
    return fit_least_squares(
        problem,
        model,
        tolerance=1e-3,
        most_evaluations=POLICY.effort.evaluations,
        drafts=False,
        roughly=True,
        goal=goal,
        begun=begun,
    )


def _key(effects: EffectSet, near: FittedSet, added: Sequence[Prospect]) -> Hashable:
    """What tells two fits apart: sets and prospects are the same only as the same objects."""
    return effects, near, tuple(added)
