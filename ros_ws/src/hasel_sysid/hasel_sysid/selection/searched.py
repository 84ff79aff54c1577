"""What a search has found, and what is asked of it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from hasel_sysid.selection.likelihood import Likelihood, Whitened
from hasel_sysid.selection.missing import Missing
from hasel_sysid.selection.sets import EffectSet, FittedSet, Prospect
from hasel_sysid.selection.worth import Worth


@dataclass(frozen=True)
class Searched:
    """known: every set that was fitted; likelihood: by which they are compared; worths, whitened: of every known set;
    first: the test of the baseline; last: of the best set; prospects: of every single effect beside the baseline;
    level: of the tests; tested: the test of any known set; beyond_noise: share of the best
    fit's squares that noise does not explain.
    """

    known: dict[EffectSet, FittedSet]
    likelihood: Likelihood
    whitened: dict[EffectSet, Whitened]
    worths: dict[EffectSet, Worth]
    first: Missing
    last: Missing
    prospects: dict[str, Prospect]
    level: float
    tested: Callable[[EffectSet], Missing]
    beyond_noise: float

    @property
    def best(self) -> EffectSet:
        """The set that is worth most, of those with plausible values."""
        return max(plausible(self.known), key=lambda effects: self.worths[effects].total)


def plausible(known: dict[EffectSet, FittedSet]) -> list[EffectSet]:
    """The sets, the empty one among them, whose values lie inside their ranges."""
    return [effects for effects, fitted in known.items() if fitted.plausible]


def likeness(likelihood: Likelihood, seen: Mapping[str, Prospect], one: str, other: str) -> float:
    """Cosine of the angle between what two effects can look like beside the baseline; 0 where that is not known."""
    if one not in seen or other not in seen:
        return 0.0
    return likelihood.likeness(seen[one].looks, seen[other].looks)


def worth_most(found: Searched) -> list[EffectSet]:
    """The plausible sets that are worth more than every known part of them, those that are worth most first."""
    return lasting(plausible(found.known), lambda one: found.worths[one].total)


def lasting(every: Sequence[EffectSet], value: Callable[[EffectSet], float]) -> list[EffectSet]:
    """The sets of more value than every part of them that is among these, the most valuable first."""
    values = {one: value(one) for one in every}
    found = [one for one in every if all(values[one] > values[part] for part in every if part < one)]
    return sorted(found, key=lambda one: -values[one])
