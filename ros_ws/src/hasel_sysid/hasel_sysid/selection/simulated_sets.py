"""Sets of effects of the simulator: drafts for a first look, full fits for what is compared."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from functools import partial

import numpy as np
from hasel_sim.effects.base import Effect
from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model
from hasel_sim.parallel import all_at_once

from hasel_sysid.diagnosis.candidates import Start, starts, valued
from hasel_sysid.diagnosis.side_by_side import go_together
from hasel_sysid.diagnosis.trial import Trial, Trials
from hasel_sysid.estimation import FitResult
from hasel_sysid.estimation.least_squares import fitted_result
from hasel_sysid.noise import NoiseModel
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Problem
from hasel_sysid.selection.first_trials import first_trials
from hasel_sysid.selection.known_set import known_set
from hasel_sysid.selection.noise_bound import bounded_noise
from hasel_sysid.selection.other_valleys import deepest
from hasel_sysid.selection.set_fits import SetFits
from hasel_sysid.selection.sets import NOTHING, EffectSet, FittedSet, Look, Prospect, Rank, Wanted
from hasel_sysid.selection.sized_starts import Expected, expected_beside, overlooked
from hasel_sysid.selection.trial_prospects import (
    best_of_each,
    from_other_sizes,
    looks_of,
    prospect_of,
)


class SimulatedSets:
    """Sets of candidate effects beside the effects that a fitted model has already."""

    def __init__(
        self,
        problem: Problem,
        fit: FitResult,
        effects: Sequence[Effect],
        slack: Sequence[np.ndarray] = (),
        given: Model | None = None,
    ) -> None:
        """slack: errors [frames] that every set makes; given: where `fit` is far off, the model to begin with: then
        every effect is looked at over the decades of its range, and where that leads far off, from the given values.
        """
        self.problem, self.fitted, self.given = problem, fit, given
        self.effects = {effect.id: effect for effect in effects}
        self.null_starts = {e.id: start for e in effects for start in starts(e)[:1] if start.changes_nothing}
        self.runs = fit.evaluation.runs
        self.measured = fit.evaluation.measured()
        self.slack = np.column_stack([np.zeros((len(self.runs), 0)), *slack])
        self.swing = problem.largest_swing
        self.tried: set[str] = set()
        self.first: list[Trial] = []
        self.trials: Trials | None = None
        self._fits = SetFits(problem, self.effects, self.slack, given)

    def baseline(self) -> FittedSet:
        """The model as it was fitted."""
        return self.known_as(self.fitted)

    def known_as(self, fit: FitResult) -> FittedSet:
        """A fit as the search sees it."""
        return known_set(fit, self.effects)

    @property
    def at_null(self) -> Collection[str]:
        """Effects that may start without effect: beside a set, one simulation has the derivatives of them all."""
        return self.null_starts.keys()

    def compatible(self, effects: EffectSet) -> bool:
        """Whether no two of them exclude each other."""
        return go_together(self.effects[effect] for effect in effects)

    def noise(self, known: Collection[FittedSet]) -> NoiseModel:
        """As measured, or as these fits bound it."""
        return self.problem.measured_noise or bounded_noise([fitted.fit.evaluation for fitted in known])

    def out_of_time(self) -> bool:
        """Whether the problem's time is over."""
        return self.problem.time_limit.is_over()

    def prospects(
        self,
        of: FittedSet,
        wanted: Collection[str] | None,
        rank: Rank,
        most: int,
        sized: Mapping[str, FittedSet] | None = None,
    ) -> dict[str, Prospect]:
        """First trials of every effect on a draft; further steps with the `most` best, and with half as many."""
        names = [e for e in (self.effects if wanted is None else wanted) if e not in of.effects]
        names = [e for e in names if self.compatible(of.effects | {e})]
        if not names:
            return {}
        trials = Trials(self.problem, of.fit.evaluation)
        if of.effects == NOTHING or not self.first:
            first = first_trials(
                trials, [self.effects[name] for name in names], decades=self.given is not None
            )
            rounds = (most, most // 2)
            self.trials, self.first, self.tried = trials, first, set(trials.tried)
        else:
            hoped, rounds = self._expected(of, names, sized or {}), (most // 2, most // 4)
            first = trials.first(self._begin(hoped, names, sized or {}))
            first = [*trials.first(overlooked(hoped, first)), *first]
        looks = {t.start.effect.id: looks_of(t, trials) for t in reversed(first)}
        best = best_of_each([prospect_of(t, looks, of.effects) for t in first], rank)
        for keep in rounds:
            if not best or not keep or self.out_of_time():
                break
            most_hope = max(prospect.start.promised for prospect in best)
            going_on = [p for p in best[:keep] if p.start.promised >= POLICY.effort.hope * most_hope]
            moved = [prospect_of(t, looks, of.effects) for t in trials.further([p.start for p in going_on])]
            best = best_of_each([*moved, *(p for p in best if p not in going_on)], rank)
        return {prospect.effect: prospect for prospect in best}

    def prospects_of_each(self, looks: Sequence[Look], rank: Rank, most: int) -> list[dict[str, Prospect]]:
        """The same beside several sets, side by side where there are processes for it."""
        calls = [partial(self.prospects, of, wanted, rank, most) for of, wanted in looks]
        return all_at_once(self.problem.pool, calls)

    def from_other_sizes(self, of: FittedSet, prospect: Prospect) -> Prospect | None:
        """The same effect from a quarter to four times the size that it was tried at."""
        return from_other_sizes(Trials(self.problem, of.fit.evaluation), prospect)

    def _expected(
        self, of: FittedSet, names: Collection[str], sized: Mapping[str, FittedSet]
    ) -> list[Expected]:
        others = set(names) - set(sized)
        first = [trial for trial in self.first if trial.start.effect.id in others]
        return expected_beside(of, first, self.fitted.evaluation.residual)

    def _begin(
        self, hoped: Sequence[Expected], names: Collection[str], sized: Mapping[str, FittedSet]
    ) -> list[Start]:
        known = [valued(self.effects[name], sized[name].fit.model.values) for name in names if name in sized]
        first = [*known, *(one.begin for one in hoped)]
        there = [start.values for start in first]
        at_null = [self.null_starts[name] for name in names if name in self.null_starts]
        return [*first, *(start for start in at_null if start.values not in there)]

    def foresee(self, likely: Sequence[Wanted]) -> None:
        """Begin these fits where processes would wait for work."""
        self._fits.foresee(likely)

    def fit(self, effects: EffectSet, near: FittedSet, added: Sequence[Prospect]) -> FittedSet | None:
        """Least squares of the model itself, from where the drafts have led."""
        return self._fits.fit(effects, near, added)

    def finished(self, every: Sequence[FittedSet]) -> Iterator[FittedSet]:
        """The same, gone on with where a fit was broken off before it had converged."""
        return self._fits.finished(every)

    def deepest(self, of: FittedSet) -> FittedSet:
        """The same, or its fit in a deeper valley that begins elsewhere on the body."""
        fit = deepest(self.problem, of.fit, of.effects, POLICY.effort.evaluations)
        return of if fit is of.fit else self.known_as(fit)

    def without(self, of: FittedSet, gone: str) -> FittedSet | None:
        """Simulated once, at the values of the others."""
        model = of.fit.model.without_effects(gone)
        try:
            return self.known_as(fitted_result(self.problem.evaluate(model, model.free), 1))
        except HaselSimError:
            return None
