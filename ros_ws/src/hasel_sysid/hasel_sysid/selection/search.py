# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The search: fit the likeliest models, linearise about the best of them, and go round again until nothing is better.

models = {nothing: the baseline}, and every candidate alone as far as it can win
repeat
    about = the likeliest of the models
    table = every set of at most three candidates, to first order about it
    new   = what the table holds to be better than any model, else parts of the answer, else its rivals: what may stand
            in a member's place, to first order about each part
    stop where there is none, or fit the first few of it
"""

from collections.abc import Callable, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from hasel_common.progress import Stage
from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model
from hasel_sim.parallel import all_at_once

from hasel_sysid.candidates import Candidate, compatible, constants_of
from hasel_sysid.estimation.covariance import changes_by_refinement
from hasel_sysid.estimation.fit import FittedModel, fit, fitted_model, mapped
from hasel_sysid.estimation.growing_horizon import in_phase
from hasel_sysid.estimation.least_squares import OPTIMISM
from hasel_sysid.estimation.starts import Screened, starts
from hasel_sysid.expected_work import (
    ALONE,
    NUMBERS,
    NUMBERS_ALONE,
    NUMBERS_OTHER_SIZES,
    OTHER_SIZES,
    ROUND,
    TYPICAL,
)
from hasel_sysid.model_checking import goodness_of_fit
from hasel_sysid.noise_bounds import known_noise
from hasel_sysid.policy import Policy
from hasel_sysid.problem import Evaluation, LowFidelityProblem, Problem
from hasel_sysid.projection import orthonormal
from hasel_sysid.selection.best_subsets import Row, best_subsets
from hasel_sysid.selection.choose import Choice, ComparedModel, Judged, choose, compare
from hasel_sysid.selection.cross_validation import leave_one_run_out
from hasel_sysid.selection.likelihood import NOTHING, FittedSet, Likelihood, Names, Whitened
from hasel_sysid.selection.linearise import CandidateColumns, linearise, secant
from hasel_sysid.selection.nothing_missing import ScoreTest, score_test
from hasel_sysid.selection.race import (
    Entries,
    at_other_sizes,
    at_typical_size,
    candidates_of,
    race,
    screen_typical,
)

_LINEARISED = 12
"""Candidates that are simulated anew beside a model, those of most score there; the others keep their secants."""

IsLaw = Callable[[FittedSet, "Likelihood"], bool]


@dataclass(frozen=True, eq=False)
class Searched:
    """models: every fitted set; choice: the answer; table: all of them, best first; likelihood: by which they are
    compared; first, last: is anything missing from the baseline, and from the answer? screened: every candidate at its
    typical size; alone: by candidate, its best low-fidelity model; discretisation: changes of the baseline's series
    [frames] by finer numerics; untried: candidates for which there was no time.
    """

    models: dict[Names, Judged]
    choice: Choice
    table: tuple[ComparedModel, ...]
    likelihood: Likelihood
    first: ScoreTest
    last: ScoreTest
    screened: list[Screened]
    alone: dict[str, Evaluation]
    discretisation: dict[str, np.ndarray]
    untried: list[str]

    @property
    def answer(self) -> FittedSet:
        """The chosen set."""
        return self.models[self.choice.chosen].fitted


class Search:
    """One search for what a fitted baseline lacks."""

    def __init__(
        self,
        problem: Problem,
        baseline: FittedModel,
        effects: Sequence[Candidate],
        policy: Policy,
        is_law: IsLaw,
        with_constants: bool = True,
        begun: Sequence[FittedSet] = (),
    ) -> None:
        """effects: the candidates; is_law: whether what a fitted set adds has one value in every run; with_constants:
        whether those of the model file come after the effects; begun: sets that were fitted already.
        """
        self.problem, self.baseline, self.effects, self.policy = problem, baseline, effects, policy
        self._is_law, self._with_constants = is_law, with_constants
        self._low = LowFidelityProblem(problem, baseline.evaluation)
        self.fits = {NOTHING: FittedSet({}, baseline), **{one.names: one for one in begun}}
        self._tried: set[Names] = set(self.fits)
        self._proposed: dict[tuple[str, Names], int] = {}
        self._columns: dict[Names, dict[str, CandidateColumns]] = {}
        self._discretisation: dict[Names, dict[str, np.ndarray]] = {}
        self.screened: list[Screened] = []
        self._constants: list[Screened] = []
        self.alone: dict[str, Evaluation] = {}
        self.untried: list[str] = []
        self.models: dict[Names, Judged] = {}
        self.threshold = 0.0
        self._judge()

    def run(self) -> Searched:
        """Search until nothing promises more, or time is over."""
        with self._stage(replace(TYPICAL, work=self._typical_work(), known=True)):
            self.screened, untried = screen_typical(self._low, self.effects)
        self.untried = [candidate.name for candidate in untried]
        self.first = self._tested(NOTHING)
        self.threshold = self.first.threshold
        if self.first.chance < self.policy.level:
            self._each_alone(ALONE, OTHER_SIZES, self.screened)
            if self._with_constants and self._something_is_missing():
                with self._stage(NUMBERS):
                    self._constants, _ = screen_typical(self._low, constants_of(self.baseline.model))
                self._each_alone(NUMBERS_ALONE, NUMBERS_OTHER_SIZES, self._constants)
            self._rounds()
        choice = self._choose()
        return Searched(
            self.models,
            choice,
            compare(self.models, choice),
            self.likelihood,
            self.first,
            self._tested(choice.chosen),
            self.screened,
            self.alone,
            self._discretisation.get(NOTHING, {}),
            self.untried,
        )

    def _typical_work(self) -> float:
        """Of simulating every typical size once."""
        model, count = self.baseline.model, sum(one.typical for each in self.effects for one in starts(each))
        return count * self.problem.work(self.problem.low_fidelity(model))

    def _stage(self, stage: Stage) -> AbstractContextManager[None]:
        return self.problem.workload.stage(stage)

    # the currency

    def _judge(self) -> None:
        """All fitted models by one covariance: the noise as it is known now, the discretisation of the likeliest."""
        noise = known_noise(self.problem, [f.fit.evaluation for f in self.fits.values()])
        known = self.baseline.evaluation
        measured = known.measured()
        about = self._likeliest() if self.models else NOTHING
        changes = self._refinement_changes(about)
        shared, free = self.problem.shared_errors, self.problem.free_offset
        self.likelihood = Likelihood(
            noise, known.runs, self.problem.discrepancy, list(changes.values()), shared, free, known.series
        )
        self.models = {}
        enough = self.policy.near_noise * self.likelihood.allowed.mean_absolute
        for names, fitted in self.fits.items():
            if fitted.has_constant and fitted.fit.mean_absolute_error > enough:
                continue  # a number that somebody measured is doubted only where it alone describes the runs
            white = self.likelihood.whitened(fitted)
            elpd = leave_one_run_out(white, measured, self.policy.prior_runs)
            self.models[names] = Judged(fitted, white, elpd)

    def _refinement_changes(self, names: Names) -> dict[str, np.ndarray]:
        """By finer numerics at a fitted set; none of a model that is out of phase, where they mean nothing."""
        if names not in self._discretisation:
            evaluation = self.fits[names].fit.evaluation
            near = in_phase(evaluation)
            self._discretisation[names] = changes_by_refinement(self.problem, evaluation) if near else {}
        return self._discretisation[names]

    def _value(self, names: Names) -> float:
        return self.models[names].whitened.logarithm - self.threshold * len(names)

    def _likeliest(self) -> Names:
        """In range or not: what takes nothing away from a model out of range does not mend it, what is added may."""
        return max(self.models, key=self._value)

    def _tested(self, names: Names) -> ScoreTest:
        """Whether anything is missing from a fitted set."""
        held = self.fits[names].candidates
        known = self._columns.get(names, {})
        looks = [
            (one.start.candidate.name, one.change[:, None])
            for one in self.screened
            if one.start.candidate.name not in known and self._fits_beside(one.start.candidate, held)
        ] + [(name, column.looks) for name, column in known.items()]
        white = [(name, self.likelihood.whiten(look)) for name, look in looks]
        return score_test(self.models[names].whitened, white, self.policy.level)

    @staticmethod
    def _fits_beside(candidate: Candidate, held: dict[str, Candidate]) -> bool:
        return candidate.name not in held and compatible([*held.values(), candidate])

    def _choose(self) -> Choice:
        self._judge()
        return choose(
            self.models,
            self.policy,
            self.threshold,
            self.excused,
            self._likeness,
            lambda names: self._is_law(self.fits[names], self.likelihood),
        )

    def excused(self, names: Names, change: np.ndarray) -> bool:
        """Whether what no model has may be all that a set lacks: it describes its runs, and that is no larger."""
        if float(np.sqrt(np.mean(change**2))) > self.problem.discrepancy:
            return False
        return goodness_of_fit(self.fits[names].fit.evaluation, self.likelihood.allowed).adequate

    def _likeness(self, one: str, other: str) -> float:
        """Cosine of the angle between what two candidates do beside the baseline."""
        base = self.models[NOTHING].whitened
        looks = [
            [
                base.beyond(self.likelihood.whiten(s.change))
                for s in self.screened
                if s.start.candidate.name == name
            ]
            for name in (one, other)
        ]
        if not all(looks):
            return 0.0
        first, second = (orthonormal(np.column_stack(own)) for own in looks)
        return float(np.linalg.norm(first.T @ second, 2)) if first.size and second.size else 0.0

    # what is fitted

    def _each_alone(self, first: Stage, then: Stage, typical: list[Screened]) -> None:
        """From typical sizes; where something is still missing, from all others."""
        with self._stage(first):
            self._race(at_typical_size(self._low, typical, self._least()))
        if self._something_is_missing():
            with self._stage(then):
                self._race(at_other_sizes(self._low, typical, self.policy.fits))

    def _race(self, entries: Entries) -> None:
        """Candidates alone: raced by the low-fidelity model, those within reach of the best then by the model."""
        for name, ended in race(self._low, entries, self.likelihood, self.policy.reach).items():
            if name not in self.alone or ended.sum_of_squares < self.alone[name].sum_of_squares:
                self.alone[name] = ended
                self._tried.discard(frozenset({name}))
        value = {n: self.likelihood.of(one.residual, one.jacobian).logarithm for n, one in self.alone.items()}
        ranked = sorted(value, key=lambda name: -value[name])
        near = [name for name in ranked if value[name] >= value[ranked[0]] - self.policy.reach]
        chosen = [frozenset({name}) for name in near[: 2 * self.policy.fits]]
        self._keep({names: partial(self._mapped, *names) for names in chosen if names not in self._tried})

    def _mapped(self, name: str) -> FittedSet:
        candidate = self._candidates()[name]
        return FittedSet({name: candidate}, fitted_model(mapped(self.problem, self.alone[name])))

    def _candidates(self) -> dict[str, Candidate]:
        return candidates_of([*self.screened, *self._constants])

    def _something_is_missing(self) -> bool:
        """From the likeliest model so far."""
        return self._tested(self._likeliest()).chance < self.policy.level

    def _least(self) -> float:
        return min(one.fit.evaluation.sum_of_squares for one in self.fits.values())

    def _rounds(self) -> None:
        """Propose and fit until nothing promises more."""
        while not self.problem.time_limit.is_over():
            rows = self._proposals(self._choose())
            if not rows:
                return
            named = Stage(", ".join(" + ".join(sorted(row.names)) for row in rows))
            with self._stage(ROUND), self._stage(named):
                self._keep({row.names: partial(self._fitted, row) for row in rows})

    def _proposals(self, choice: Choice) -> list[Row]:
        """What to fit next: better than any model, else parts of the answer, else its rivals.

        First order is believed for one candidate more than a fitted set has at a time, and for two beside the baseline,
        which may hide each other.
        """
        about = self._likeliest()
        answer = choice.chosen
        most = min(self.policy.most_effects, max(2, len(about) + 1))
        better = [
            row
            for row in self._table(about, most)
            if row.names not in self._tried
            and row.logarithm - self.threshold * len(row.names) > self._value(about)
        ]
        parts = [answer - {gone} for gone in sorted(answer)]
        values = self.fits[answer].fit.model.values
        return (
            self._first("better", about, better)
            or [Row(part, 0.0, values) for part in parts if part not in self._tried]
            or [row for part in parts for row in self._first("rival", part, self._rivals(answer, part))]
        )

    def _rivals(self, answer: Names, part: Names) -> list[Row]:
        """Sets with another candidate beside a part of the answer, if twice what first order about that part promises
        brings them within reach of the answer. Beside nothing the race has answered.
        """
        if not part or part not in self.models:
            return []
        without, whole = (self.models[names].whitened.logarithm for names in (part, answer))
        return [
            row
            for row in self._table(part, len(answer), part)
            if len(row.names) == len(answer)
            and row.names not in self._tried
            and OPTIMISM * (row.logarithm - without) >= whole - without - self.policy.reach
        ]

    def _first(self, kind: str, of: Names, rows: Sequence[Row]) -> list[Row]:
        """Of one table no more than the first few are followed: where they were no better, first order is not true."""
        done = self._proposed.get((kind, of), 0)
        found = list(rows[: self.policy.fits - done])
        self._proposed[(kind, of)] = done + len(found)
        return found

    def _table(self, about: Names, most: int, holding: Names = NOTHING) -> list[Row]:
        """Every set of so many candidates that has these, to first order about a fitted one."""
        if about not in self._columns:
            self._columns[about] = self._linearised(about)
        columns = self._columns[about]
        return best_subsets(self.fits[about], columns, self.likelihood, most, self.threshold, holding)

    def _linearised(self, about: Names) -> dict[str, CandidateColumns]:
        """Columns of every candidate that fits beside a set: by its own derivatives there where its score is more than
        noise makes of it, at the size that explains most in proportion; else by the secant that is known from beside
        the baseline.
        """
        of, white = self.fits[about], self.models[about].whitened
        best: dict[str, tuple[float, float, Screened]] = {}
        for one in self.screened:
            candidate = one.start.candidate
            if self._fits_beside(candidate, of.candidates):
                gain, amount = _gain(white, self.likelihood.whiten(one.change))
                best[candidate.name] = max(
                    best.get(candidate.name, (-1.0, 0.0, one)), (gain, amount, one), key=lambda g: g[0]
                )
        ranked = sorted(best.values(), key=lambda gained: -gained[0])
        columns = {one.start.candidate.name: secant(one) for *_, one in ranked}
        promising = [
            one.start.where_it_explains(amount) for gain, amount, one in ranked if gain > self.threshold
        ][:_LINEARISED]
        if about != NOTHING and promising:
            problem = LowFidelityProblem(self.problem, of.fit.evaluation)
            columns |= {one.candidate.name: one for one in linearise(problem, of, promising)}
        return columns

    def _fitted(self, row: Row) -> FittedSet:
        """A set from where the table leads, and from what its candidates are alone."""
        known = self._candidates()
        candidates = {name: known[name] for name in sorted(row.names)}
        model = self.baseline.model
        for candidate in candidates.values():
            model = candidate.added_to(model)
        about = self.fits[self._likeliest()].fit.model.values
        alone = {
            path: self.alone[name].model.values[path]
            for name, candidate in candidates.items()
            if name in self.alone
            for path in candidate.names
        }
        begin = [_at(model, row.values)]
        if len(candidates) > 1 and alone:
            begin.append(_at(model, {**about, **row.values, **alone}))
        return FittedSet(candidates, fit(self.problem, self._low, begin))

    def _keep(self, fits: dict[Names, Callable[[], FittedSet]]) -> None:
        """Make these fits side by side; one that cannot be simulated is left out."""
        self._tried |= set(fits)
        for found in all_at_once(self.problem.pool, [partial(_if_possible, call) for call in fits.values()]):
            if found is not None:
                self.fits[found.names] = found
        self._judge()


def _if_possible(call: Callable[[], FittedSet]) -> FittedSet | None:
    try:
        return call()
    except HaselSimError:
        return None


def _gain(fitted: Whitened, column: np.ndarray) -> tuple[float, float]:
    """Of the log-likelihood, by a whitened column [frames] beside a fitted model, and by how many times of it."""
    look = fitted.beyond(column)
    power = float(look @ look)
    score = float(look @ fitted.residual)
    return (0.5 * score**2 / power, score / power) if power > 0 else (0.0, 0.0)


def _at(model: Model, values: dict[str, float]) -> Model:
    """The model at these values, as far as it has them, each within its range."""
    return model.with_values(
        {
            name: float(np.clip(values[name], model.parameters[name].lower, model.parameters[name].upper))
            for name in model.free
            if name in values
        }
    )
