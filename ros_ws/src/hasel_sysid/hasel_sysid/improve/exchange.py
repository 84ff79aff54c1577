"""Second thoughts: with a second effect in the model, was the first the right one of those that looked alike?"""

from collections.abc import Sequence

from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis, Finding
from hasel_sysid.diagnosis.context import on_own_bound
from hasel_sysid.fit import FitResult, fit_least_squares
from hasel_sysid.improve.result import Stage
from hasel_sysid.problem import Problem


def exchanged(problem: Problem, stages: Sequence[Stage], accepted: Finding) -> FitResult:
    """The accepted fit, or a better one in which the effect added last gives way to one that looked alike.

    Two things wrong at once make the first choice a guess: what a stiffness is wrong by, a damping law may imitate.
    Only effects that the diagnosis before could not tell from the first are tried, each refitted with the new one.
    """
    best = accepted.fit
    if len(stages) < 2:
        return best
    before, chosen = stages[-2], stages[-1].effects[-1]
    if before.diagnosis is None:
        return best
    group = next((g for g in before.diagnosis.groups if chosen in g), ())
    for rival in group:
        if rival in (chosen, accepted.effect):
            continue
        try:
            model = with_effect(before.fit.model, before.diagnosis, rival)
            model = with_effect(model, stages[-1].diagnosis, accepted.effect)
            fit = fit_least_squares(problem, model, most_evaluations=8, drafts=False)
        except HaselSimError:
            continue
        better = fit.evaluation.sum_of_squares < best.evaluation.sum_of_squares
        if better and not on_own_bound(rival, fit) and not on_own_bound(accepted.effect, fit):
            best = fit
    return best


def with_effect(model: Model, diagnosis: Diagnosis, effect: str) -> Model:
    """The model with an effect, at the values that its diagnosis fitted, else at a typical size.

    Raises ModelError where the effect does not go with the model's.
    """
    finding = diagnosis.finding(effect)
    extended = model.with_effects(finding.source or effect)
    fitted = finding.fit
    kind = next(e for e in extended.effects if e.id == effect)
    names = [f"{effect}.{p.name}" for p in kind.parameters]
    values = dict(zip(names, kind.typical().values(), strict=True))
    if fitted is not None:
        values = {name: fitted.model.values[name] for name in names}
    return extended.with_values(values)
