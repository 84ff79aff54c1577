# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a muscle's law lacks: the search of the swimmer's `improve` among the effects of a muscle, stage by stage."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import cast

import numpy as np
from hasel_sim.effects.base import Effect
from hasel_sim.muscle.effect import find_muscle_effects, muscle_catalogue
from hasel_sim.muscle.muscle import Muscle
from hasel_sysid.answer.diagnosis import Finding, Verdict, said_beside
from hasel_sysid.answer.result import Status
from hasel_sysid.answer.verdict import DETECTION, findings, share_left, status_with
from hasel_sysid.candidates import Candidate
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation.covariance import with_numerical_error
from hasel_sysid.estimation.fit import FittedModel, descend, exact, fit_from_starts, fitted_model
from hasel_sysid.estimation.starts import starts
from hasel_sysid.model_checking import GoodnessOfFit, goodness_of_fit
from hasel_sysid.noise import allowed_noise
from hasel_sysid.policy import POLICY
from hasel_sysid.selection.choose import confidence_set
from hasel_sysid.selection.likelihood import Names, out_of_range
from hasel_sysid.selection.search import Search, Searched

from hasel_muscle.bench_problem import BenchProblem, as_model, as_muscle


class BenchVerdict(Enum):
    """In the order in which they are listed."""

    MISSING = "missing"
    AS_GOOD = "as good as the one that was added"
    BEYOND = "would help, but only beyond its plausible range"
    ABSENT = "absent"
    NOT_JUDGED = "not judged"
    UNSEEN = "cannot be seen"


@dataclass(frozen=True)
class BenchFinding:
    """An effect, what is said of it, and why."""

    effect: str
    verdict: BenchVerdict
    reason: str

    def __str__(self) -> str:
        return f"{self.effect}: {self.verdict.value}; {self.reason}."


@dataclass(frozen=True)
class Described:
    """goodness: whether a law describes its lifts; error: root mean square by the largest answer, and allowed, what
    that may be; noise, repeats: what is allowed for, likewise.
    """

    goodness: GoodnessOfFit
    error: float
    allowed: float
    noise: float
    repeats: float | None

    @property
    def describes(self) -> bool:
        """Whether nothing is left but noise."""
        return self.goodness.adequate

    def __str__(self) -> str:
        of = f"noise {100 * self.noise:.2g} %"
        of += "" if self.repeats is None else f", lifts repeat to {100 * self.repeats:.2g} %"
        said = "describes these lifts" if self.describes else "does not describe these lifts yet"
        worst = "; most in " + ", ".join(map(str, self.goodness.lacking[:3])) if self.goodness.lacking else ""
        return (
            f"The model {said}: it is off by {100 * self.error:.2g} % of the largest answer, "
            f"{100 * self.allowed:.2g} % are allowed for ({of}){worst}."
        )


@dataclass(frozen=True)
class MuscleStage:
    """What was added, the fit with it, and mean |law - measurement| by unit, of fitted and of unseen lifts."""

    added: tuple[str, ...]
    fit: FittedModel
    error: dict[str, float]
    unseen: dict[str, float]
    rivals: tuple[str, ...] = ()

    @property
    def muscle(self) -> Muscle:
        """With the fitted values."""
        return as_muscle(self.fit.model)


@dataclass(frozen=True)
class BenchImprovement:
    """stages: the file's own constants, the fitted law, then with every effect added; findings: of all effects; status:
    as of the swimmer's `improve`; described: whether the last stage describes its lifts; groups: effects that these
    lifts cannot tell apart.
    """

    stages: tuple[MuscleStage, ...]
    findings: tuple[BenchFinding, ...]
    status: Status
    described: Described
    groups: tuple[tuple[str, ...], ...] = ()

    @property
    def muscle(self) -> Muscle:
        """With everything that was added."""
        return self.stages[-1].muscle

    @property
    def missing(self) -> list[str]:
        """What was added, in this order."""
        return [name for stage in self.stages[2:] for name in stage.added]


_OFTEN = replace(POLICY, fits=12)
"""A formula costs little: more models are fitted than of a body that is simulated."""
_FEWEST_VOLTAGES = 5
"""Of fewer, each left out once, the differences scatter too little to be known."""


def fit_muscle(problem: BenchProblem, muscle: Muscle) -> FittedModel:
    """What is free of a muscle, fitted to settled frames."""
    return _with_errors(problem, fit_from_starts(problem, as_model(muscle)))


def _with_errors(problem: BenchProblem, fit: FittedModel) -> FittedModel:
    """A fit with standard errors that hold what the zero is uncertain by; what stands on a bound stays there."""
    moving = [name for name in fit.evaluation.names if name not in fit.at_bound]
    free = fitted_model(fit.evaluation.by(moving))
    shared = {f"zero {number}": change for number, change in enumerate(problem.shared_errors)}
    covariance = with_numerical_error(free.evaluation, free.model.covariance(moving), shared)
    held = {name: free.model.values[name] for name in fit.at_bound}
    model = free.model.with_covariance(moving, covariance)
    return replace(fit, model=model.with_values(held, dict.fromkeys(held)))


def described(problem: BenchProblem, fit: FittedModel) -> Described:
    """Whether a fitted law describes its lifts to what frames and repeated lifts scatter by."""
    noise = problem.measured_noise
    allowed = allowed_noise(noise, problem.discrepancy)
    return Described(
        goodness_of_fit(fit.evaluation, allowed),
        float(np.sqrt(np.mean(fit.evaluation.residual**2))),
        POLICY.near_noise * allowed.standard_deviation,
        noise.standard_deviation,
        problem.repeatability,
    )


def improve_muscle(
    problem: BenchProblem, muscle: Muscle, unseen: BenchProblem | None = None, candidates: Sequence[str] = ()
) -> BenchImprovement:
    """Compare, fit, and add the smallest set of effects that predicts voltages left out as well as the best one.

    unseen: lifts that are only ever compared with; candidates: ids of the effects (default: the whole catalogue).
    Raises SysidError where there are too few voltages to leave any out.
    """
    if (count := len(problem.voltages)) < _FEWEST_VOLTAGES:
        raise SysidError(
            f"these recordings lift at {count} voltages; expected {_FEWEST_VOLTAGES} and more, as what is missing is "
            "judged on voltages left out: record more, or use --fit-only"
        )

    def stage(fit: FittedModel, added: tuple[str, ...] = (), rivals: tuple[str, ...] = ()) -> MuscleStage:
        law = as_muscle(fit.model)
        apart = {} if unseen is None else unseen.error(law)
        return MuscleStage(added, fit, problem.error(law), apart, rivals)

    fit = fit_muscle(problem, muscle)
    present = {effect.id for effect in muscle.effects}
    effects = [
        Candidate(effect.id, effect.parameters, cast(Effect, effect))
        for effect in find_muscle_effects(tuple(candidates or muscle_catalogue()))
        if effect.id not in present
    ]
    found = Search(problem, fit, effects, _OFTEN, lambda *_: True, with_constants=False).run()
    stages = [stage(fitted_model(problem.evaluate(as_model(muscle)))), stage(fit)]
    path, groups = found.choice.path, _groups(found)
    for before, names in zip(path, path[1:], strict=False):
        new = names - before
        last = _with_errors(problem, exact(problem, found.models[names].fitted.fit))
        rivals = {other for group in groups if new & set(group) for other in group} - found.choice.chosen
        stages.append(stage(last, tuple(sorted(new)), tuple(sorted(rivals))))
    status = _status(found, stages, described(problem, stages[-1].fit).describes)
    stages = stages[:2] if status is Status.UNEXPLAINED else stages
    told = described(problem, stages[-1].fit)
    said = _findings(problem, found, effects, stages, told.describes)
    return BenchImprovement(tuple(stages), said, status, told, groups)


def _groups(found: Searched) -> tuple[tuple[str, ...], ...]:
    """Effects that these lifts cannot tell apart; of one effect also those that do what a free constant does.

    Where that constant alone would leave its range such an effect is needed, and no double of it.
    """
    if len(found.choice.chosen) != 1:
        return found.choice.groups
    models = {
        names: replace(one, fitted=replace(one.fitted, fit=replace(one.fitted.fit, undetermined=())))
        for names, one in found.models.items()
    }
    alike = sorted(frozenset().union(*confidence_set(models, found.choice.chosen, POLICY)))
    return (tuple(alike),) if len(alike) > 1 else ()


def _status(found: Searched, stages: Sequence[MuscleStage], describes: bool) -> Status:
    nothing_else = found.last.chance >= POLICY.level
    if not found.choice.chosen:
        return Status.NOTHING_MISSING if describes and nothing_else else Status.UNEXPLAINED
    before, after = (stage.fit.mean_absolute_error for stage in (stages[1], stages[-1]))
    return status_with(share_left(before, after, found.likelihood.allowed), describes, nothing_else)


def _findings(
    problem: BenchProblem,
    found: Searched,
    effects: list[Candidate],
    stages: list[MuscleStage],
    describes: bool,
) -> tuple[BenchFinding, ...]:
    """What is said of every effect, beside those that were added."""
    added = [name for stage in stages[2:] for name in stage.added]
    of = {effect.name: effect for effect in effects}
    said = []
    for one in findings(found, effects, frozenset(added)):
        one = said_beside(one, describes, added)
        if one.verdict is Verdict.ABSENT and _may_hide(problem, found, of[one.effect], frozenset(added)):
            one = replace(one, verdict=Verdict.CANNOT_BE_SEEN)
        said.append(BenchFinding(one.effect, *_judged(one, found, stages, describes)))
    order = list(BenchVerdict)
    return tuple(sorted(said, key=lambda each: order.index(each.verdict)))


def _may_hide(problem: BenchProblem, found: Searched, candidate: Candidate, beside: Names) -> bool:
    """Whether these lifts are as likely with it at its typical size, everything else fitted again: to first order alone
    a scale of the force, which a free permittivity imitates to the last digit, would be seen.
    """
    answer = found.models[beside]
    begin = [start.model(answer.fitted.fit.model) for start in starts(candidate) if start.typical]
    ended = descend(problem, [model.with_held(*candidate.names) for model in begin])
    likely = [found.likelihood.of(one.residual, one.jacobian).logarithm for one in ended]
    return answer.whitened.logarithm - max(likely, default=-np.inf) < 0.5 * DETECTION**2


def _judged(
    one: Finding, found: Searched, stages: Sequence[MuscleStage], describes: bool
) -> tuple[BenchVerdict, str]:
    """Verdict and reason."""
    name = one.effect
    alone = found.models.get(frozenset({name}))
    instead = [" and ".join(stage.added) for stage in stages[2:] if name in stage.rivals]
    if one.verdict is Verdict.MISSING:
        return BenchVerdict.MISSING, _sizes(stages[-1].muscle, name)
    if instead:
        return BenchVerdict.AS_GOOD, f"these lifts cannot tell it from {' and '.join(instead)}"
    if alone and any(out_of_range(c, alone.fitted.fit) for c in alone.fitted.candidates.values()):
        return BenchVerdict.BEYOND, _sizes(as_muscle(alone.fitted.fit.model), name)
    if not describes:
        return BenchVerdict.NOT_JUDGED, "the model does not describe these lifts yet"
    if one.verdict is Verdict.ABSENT:
        path, unit = next(iter(one.units.items()))
        limit = f"{path} {one.null + one.visible_above:.2g}" + ("" if unit == "1" else f" {unit}")
        return BenchVerdict.ABSENT, f"at most {limit}"
    if one.verdict is Verdict.MISSING_IF_SIZE_MATTERS:
        return (
            BenchVerdict.NOT_JUDGED,
            "it may be there, but voltages left out are predicted as well without it",
        )
    reason = "beside what is free, its typical size would change these lifts by less than their noise"
    return BenchVerdict.UNSEEN, reason


def _sizes(muscle: Muscle, name: str) -> str:
    return ", ".join(str(p) for key, p in muscle.parameters.items() if key.startswith(f"{name}."))
