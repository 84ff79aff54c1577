"""A constant of the model file that does by itself what several effects do together, or what none does."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from hasel_sim.errors import HaselSimError
from hasel_sim.model import Model, Parameter
from hasel_sim.model.constants import constants, shared_constants
from hasel_sim.model.value_text import value_with_error

from hasel_sysid.diagnosis.adequacy import adequacy
from hasel_sysid.draft import draft
from hasel_sysid.estimation import FitResult, fit_least_squares
from hasel_sysid.estimation.bounded import bounded_change
from hasel_sysid.policy import Policy
from hasel_sysid.problem import Evaluation, Problem
from hasel_sysid.selection.choice import does_as_much
from hasel_sysid.selection.searched import Searched
from hasel_sysid.selection.sets import NOTHING, EffectSet, name_of
from hasel_sysid.selection.simulated_sets import SimulatedSets
from hasel_sysid.selection.verdicts import noise_allowed
from hasel_sysid.selection.worth import worth

_RANGE = 0.3, 3.0
"""How far a constant may be from what the file says, as the scale of a modulus may."""


@dataclass(frozen=True)
class WrongConstant:
    """name: its path in the model file; fit: of the model with it free, instead of any effect; instead_of: the effects
    that come to no more; empty where no effects do.
    """

    name: str
    given: float
    fit: FitResult
    instead_of: EffectSet

    @property
    def parameter(self) -> Parameter:
        """Its value and standard error."""
        return self.fit.model.parameters[self.name]

    def __str__(self) -> str:
        p = self.parameter
        value = value_with_error(p.value, p.standard_error, p.unit)
        unit = "" if p.unit == "1" else f" {p.unit}"
        does = (
            f"does as much as {name_of(self.instead_of)}"
            if self.instead_of
            else "does what no listed effect does"
        )
        return (
            f"One number of the model file, {self.name} = {value} in place of {self.given:g}{unit}, {does}: measure it "
            "before an effect is believed in."
        )

    def to_json(self) -> dict:
        """For `improve --json`."""
        p = self.parameter
        return {
            "name": self.name,
            "given": self.given,
            "value": p.value,
            "std": p.standard_error,
            "unit": p.unit,
            "instead_of": sorted(self.instead_of),
        }


def wrong_constant(
    sets: SimulatedSets, found: Searched, chosen: EffectSet, policy: Policy
) -> WrongConstant | None:
    """The constant with which the model describes its runs, and foretells runs left out as well as with the chosen
    effects, to within the same standard error.

    None where no constant does, where nothing is missing, and where one effect is chosen, which is as simple.
    """
    if len(chosen) == 1 or found.first.chance >= policy.level:
        return None
    base = found.known[NOTHING]
    least = found.known[chosen].squares if chosen else 0.0
    hoped = base.squares - policy.effort.hope * (base.squares - least)
    looks = [look for look in _looks(sets.problem, base.fit.evaluation) if look[1] <= hoped]
    looks.sort(key=lambda look: look[1])
    fits = [
        (name, _fitted(sets.problem, base.fit.model, name, policy)) for name, _ in looks[: policy.effort.fits]
    ]
    good = [(name, fit) for name, fit in fits if fit and _is_good(sets, found, name, fit, chosen, policy)]
    if not good:
        return None
    name, fit = min(good, key=lambda one: one[1].evaluation.sum_of_squares)
    return WrongConstant(name, constants(fit.model.description)[name], fit, chosen)


def _is_good(
    sets: SimulatedSets, found: Searched, name: str, fit: FitResult, chosen: EffectSet, policy: Policy
) -> bool:
    whitened = found.likelihood.whitened(sets.known_as(fit))
    its = worth(whitened, sets.measured, policy.prior_runs)
    describes = adequacy(fit.evaluation, noise_allowed(sets, found)).adequate
    as_much = does_as_much(found, its, fit.evaluation.residual, chosen, policy)
    return name not in fit.at_bound and describes and as_much


def _looks(problem: Problem, fitted: Evaluation) -> Iterator[tuple[str, float]]:
    """Every constant with the sum of squares that one bounded step of it, and of all that was fitted, promises."""
    model = draft(fitted.model)
    if problem.time_limit.is_over():
        return
    shared = shared_constants(model.description)
    known = {n: v for n, v in constants(model.description).items() if v and n not in model.parameters}
    # what materials share and what is one's own change the same numbers, so that they are looked at one after the other
    for names in ([n for n in known if n in shared], [n for n in known if n not in shared]):
        if not names:
            continue
        try:
            seen = problem.evaluate(model.with_freed(*names), (*fitted.names, *names))
        except HaselSimError:
            continue
        for name in names:
            yield name, _promised(seen.by((*fitted.names, name)), fitted, name)


def _promised(seen: Evaluation, fitted: Evaluation, name: str) -> float:
    freed = _freed(fitted.model, name)
    parameters = [freed.parameters[own] for own in seen.names]
    lower, upper = (np.array([getattr(p, side) - p.value for p in parameters]) for side in ("lower", "upper"))
    return float(bounded_change(fitted.residual, seen.jacobian, lower, upper)[1])


def _freed(model: Model, name: str) -> Model:
    """The model with a constant free within its range."""
    freed = model.with_freed(name)
    p = freed.parameters[name]
    ends = sorted(share * p.value for share in _RANGE)
    return replace(freed, parameters={**freed.parameters, name: replace(p, lower=ends[0], upper=ends[1])})


def _fitted(problem: Problem, model: Model, name: str, policy: Policy) -> FitResult | None:
    """None where it cannot be simulated, ends at what no model file may say, or there is no time."""
    if problem.time_limit.is_over():
        return None
    try:
        fit = fit_least_squares(
            problem,
            _freed(model, name),
            tolerance=1e-3,
            most_evaluations=policy.effort.evaluations,
            drafts=False,
        )
        fit.model.with_constants_settled(name)
    except HaselSimError:
        return None
    return fit
