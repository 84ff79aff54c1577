"""Which explanations are to be told apart."""

from collections.abc import Callable, Sequence

from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.errors import SysidError
from hasel_sysid.estimation.least_squares import minimise
from hasel_sysid.problem import Problem

_BRIEF = 8
"""Evaluations for a fit of what the diagnosis did not think worth one."""


def rivals(diagnosis: Diagnosis, fit: Callable[[Model], Model] | None = None) -> dict[str, Model]:
    """The refitted models of the explanations that are still in the running, at least two, by effect.

    fit: where somebody asked for these effects and one alone is in the running, this fits the next of the ranking, to
    be compared with it all the same. Raises SysidError when there are not two to tell apart.
    """
    fitted = _refitted(diagnosis)
    if fit is not None:
        fitted = _at_least_two(fit, diagnosis, fitted)
    if len(fitted) < 2:
        raise SysidError(
            "fewer than two explanations are left, so there is nothing to tell apart; "
            "name two with --effects to compare them all the same"
        )
    return fitted


def in_doubt(diagnosis: Diagnosis, accepted: Sequence[str]) -> dict[str, Model]:
    """The refitted models that these recordings cannot tell from the first accepted effect's, itself among them.

    Where nothing was accepted, all that were refitted; fewer than two leave nothing to tell apart.
    """
    fitted = _refitted(diagnosis)
    if not accepted:
        return fitted
    group = next((group for group in diagnosis.groups if accepted[0] in group), ())
    return {effect: model for effect, model in fitted.items() if effect in group}


def _refitted(diagnosis: Diagnosis) -> dict[str, Model]:
    return {finding.effect: finding.fit.model for finding in diagnosis.findings if finding.fit is not None}


def fitted_briefly(problem: Problem, model: Model) -> Model:
    """A model fitted to the runs of a problem, as far as a few evaluations lead."""
    return minimise(problem, problem.evaluate(model, model.free), 1e-3, _BRIEF)[0].model


def _at_least_two(
    fit: Callable[[Model], Model], diagnosis: Diagnosis, fitted: dict[str, Model]
) -> dict[str, Model]:
    found = dict(fitted)
    rest = [finding.effect for finding in diagnosis.findings if finding.effect not in fitted]
    for effect in rest:
        if len(found) >= 2:
            break
        try:
            found[effect] = fit(with_effect(diagnosis.fit.model, diagnosis, effect))
        except HaselSimError:
            continue
    return found


def with_effect(model: Model, diagnosis: Diagnosis, effect: str) -> Model:
    """The model with an effect at a typical size, as none was fitted; raises ModelError where it does not fit in."""
    extended = model.with_effects(diagnosis.finding(effect).source or effect)
    kind = next(each for each in extended.effects if each.id == effect)
    names = [f"{effect}.{parameter.name}" for parameter in kind.parameters]
    return extended.with_values(dict(zip(names, kind.typical().values(), strict=True)))
