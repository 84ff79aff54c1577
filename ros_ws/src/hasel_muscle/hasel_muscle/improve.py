"""What a muscle's law lacks: the search of the swimmer's `improve`, among the effects of a muscle."""

from collections.abc import Sequence
from dataclasses import replace
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
from hasel_sysid.estimation.fit import (
    FittedModel,
    descend,
    exact,
    fit_from_starts,
    fitted_model,
)
from hasel_sysid.estimation.starts import starts
from hasel_sysid.model_checking import goodness_of_fit
from hasel_sysid.noise import allowed_noise
from hasel_sysid.policy import POLICY
from hasel_sysid.selection.choose import confidence_set
from hasel_sysid.selection.likelihood import Names, out_of_range
from hasel_sysid.selection.search import Search, Searched

from hasel_muscle.problem import BenchProblem, as_model, as_muscle
from hasel_muscle.result import BenchFinding, BenchImprovement, BenchVerdict, Described, MuscleStage

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
    return replace(
        fit, model=free.model.with_covariance(moving, covariance).with_values(held, dict.fromkeys(held))
    )


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
    problem: BenchProblem,
    muscle: Muscle,
    unseen: BenchProblem | None = None,
    candidates: Sequence[str] | None = None,
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
        return MuscleStage(
            added, fit, problem.error(law), {} if unseen is None else unseen.error(law), rivals
        )

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
    return BenchImprovement(
        tuple(stages), _findings(problem, found, effects, stages, told.describes), status, told, groups
    )


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
    effects: Sequence[Candidate],
    stages: Sequence[MuscleStage],
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
        said.append(_finding(one, found, stages, describes))
    order = list(BenchVerdict)
    return tuple(sorted(said, key=lambda each: order.index(each.verdict)))


def _may_hide(problem: BenchProblem, found: Searched, candidate: Candidate, beside: Names) -> bool:
    """Whether these lifts are as likely with it at its typical size, everything else fitted again: to first order alone
    a scale of the force, which a free permittivity imitates to the last digit, would be seen.
    """
    answer = found.models[beside]
    begin = [start.model(answer.fitted.fit.model) for start in starts(candidate) if start.typical]
    ended = descend(problem, [model.with_held(*candidate.names) for model in begin])
    likely = max(
        (found.likelihood.of(one.residual, one.jacobian).logarithm for one in ended), default=-np.inf
    )
    return answer.whitened.logarithm - likely < 0.5 * DETECTION**2


def _finding(one: Finding, found: Searched, stages: Sequence[MuscleStage], describes: bool) -> BenchFinding:
    name = one.effect
    alone = found.models.get(frozenset({name}))
    instead = [" and ".join(stage.added) for stage in stages[2:] if name in stage.rivals]
    if one.verdict is Verdict.MISSING:
        return BenchFinding(name, BenchVerdict.MISSING, _sizes(stages[-1].muscle, name))
    if instead:
        reason = f"these lifts cannot tell it from {' and '.join(instead)}"
        return BenchFinding(name, BenchVerdict.AS_GOOD, reason)
    if alone and any(out_of_range(c, alone.fitted.fit) for c in alone.fitted.candidates.values()):
        return BenchFinding(name, BenchVerdict.BEYOND, _sizes(as_muscle(alone.fitted.fit.model), name))
    if not describes:
        return BenchFinding(name, BenchVerdict.NOT_JUDGED, "the model does not describe these lifts yet")
    if one.verdict is Verdict.ABSENT:
        path, unit = next(iter(one.units.items()))
        limit = f"{path} {one.null + one.visible_above:.2g}" + ("" if unit == "1" else f" {unit}")
        return BenchFinding(name, BenchVerdict.ABSENT, f"at most {limit}")
    if one.verdict is Verdict.MISSING_IF_SIZE_MATTERS:
        reason = "it may be there, but voltages left out are predicted as well without it"
        return BenchFinding(name, BenchVerdict.NOT_JUDGED, reason)
    reason = "beside what is free, its typical size would change these lifts by less than their noise"
    return BenchFinding(name, BenchVerdict.UNSEEN, reason)


def _sizes(muscle: Muscle, name: str) -> str:
    return ", ".join(str(p) for key, p in muscle.parameters.items() if key.startswith(f"{name}."))
