"""A constant of the model file that does by itself what several effects do together, or what none does."""

from dataclasses import dataclass

from hasel_sim.model import Parameter
from hasel_sim.model.constants import constants
from hasel_sim.model.value_text import value_with_error

from hasel_sysid.estimation import FitResult
from hasel_sysid.improvement.constant_fits import ConstantFits
from hasel_sysid.policy import Policy
from hasel_sysid.selection.choice import does_as_much
from hasel_sysid.selection.searched import Searched
from hasel_sysid.selection.sets import EffectSet, name_of
from hasel_sysid.selection.simulated_sets import SimulatedSets
from hasel_sysid.selection.verdicts import describes, noise_allowed
from hasel_sysid.selection.worth import worth


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
    sets: SimulatedSets, found: Searched, chosen: EffectSet, policy: Policy, constant_fits: ConstantFits
) -> WrongConstant | None:
    """The constant with which the model describes its runs, if the chosen effects do, and foretells runs left out as
    well as with them, to within the same standard error.

    None where no constant does, where nothing is missing, and where one effect is chosen, which is as simple.
    """
    if len(chosen) == 1 or found.first.chance >= policy.level:
        return None
    least = found.known[chosen].squares if chosen else 0.0
    allowed = len(sets.measured) * noise_allowed(sets, found).standard_deviation ** 2
    fits = constant_fits.promising(least, allowed)
    if not chosen or describes(sets, found, found.known[chosen].fit):
        fits = {name: fit for name, fit in fits.items() if describes(sets, found, fit)}
    good = {name: fit for name, fit in fits.items() if _is_good(sets, found, name, fit, chosen, policy)}
    if not good:
        return None
    name = min(good, key=lambda one: good[one].evaluation.sum_of_squares)
    return WrongConstant(name, constants(sets.fitted.model.description)[name], good[name], chosen)


def _is_good(
    sets: SimulatedSets, found: Searched, name: str, fit: FitResult, chosen: EffectSet, policy: Policy
) -> bool:
    whitened = found.likelihood.whitened(sets.known_as(fit))
    its = worth(whitened, sets.measured, policy.prior_runs)
    as_much = does_as_much(found, its, fit.evaluation.residual, chosen, policy)
    return name not in fit.at_bound and as_much
