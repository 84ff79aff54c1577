"""Where to stop, what cannot be told from it, and how probable every set is."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import takewhile

import numpy as np
from scipy.optimize import linear_sum_assignment

from hasel_sysid.policy import Policy
from hasel_sysid.selection.searched import Searched, likeness, plausible
from hasel_sysid.selection.sets import NOTHING, EffectSet
from hasel_sysid.selection.squares import log_squares, squares_judge, surely_larger
from hasel_sysid.selection.worth import Worth

_RESAMPLED = 2000


@dataclass(frozen=True)
class Choice:
    """chosen: the set to take; alike: sets of the same size that cannot be told from it, itself among them; weights: of
    every set that was fitted, together one; path: from no effect to the chosen set, one more at a time; groups: for
    every chosen effect for which there are such, those that may stand in its place, itself among them; lawless: sets
    that would have been taken, were they laws.
    """

    chosen: EffectSet
    alike: tuple[EffectSet, ...]
    weights: dict[EffectSet, float]
    path: tuple[EffectSet, ...]
    groups: tuple[tuple[str, ...], ...]
    lawless: tuple[EffectSet, ...] = ()

    def weight_of(self, effect: str) -> float:
        """Of all sets with an effect."""
        return sum(weight for effects, weight in self.weights.items() if effect in effects)


def choose(found: Searched, policy: Policy, lawful: Callable[[EffectSet], bool] | None = None) -> Choice:
    """The smallest set that is worth as much as the best one, to within its standard error, or leaves hardly more.

    No set is chosen where nothing is missing. Of sets that cannot be told apart, those come first whose values are not
    on the edge of their ranges: where the range of one law ends, that of another may go on. lawful: the first that is a
    law stands in the place of the others; where none is, the set stays.
    """
    same = all_alike(found, smallest(found, policy), policy)
    same = sorted(same, key=lambda s: found.known[s].on_edge)
    lawless = () if lawful is None else tuple(takewhile(lambda s: not lawful(s), same))
    if len(lawless) == len(same):
        lawless = ()
    chosen = same[len(lawless)]
    return Choice(
        chosen,
        tuple(s for s in same if s not in lawless),
        weights(found, chosen),
        _path(found, chosen),
        _groups(found, chosen, [s for s in same if s not in lawless]),
        lawless,
    )


def smallest(found: Searched, policy: Policy) -> EffectSet:
    """The set to take; none where nothing is missing."""
    if found.first.chance >= policy.level:
        return NOTHING
    enough = [s for s in plausible(found.known) if _worth_as_much(found, s, policy)]
    return min(enough, key=lambda s: (len(s), -found.worths[s].total))


def _worth_as_much(found: Searched, effects: EffectSet, policy: Policy) -> bool:
    return does_as_much(found, found.worths[effects], found.known[effects].residual, found.best, policy)


def does_as_much(
    found: Searched, worth: Worth, residual: np.ndarray, than: EffectSet, policy: Policy
) -> bool:
    """Whether a model of this worth, which leaves this residual [frames], stands for a known set that is larger."""
    more = found.worths[than].over(worth)
    if more.total <= policy.standard_errors * more.standard_error:
        return True
    # what finer numerics would take away as well is not to an effect's credit
    left = [
        found.likelihood.squares_beyond_slack(each, policy.doubt)
        for each in (residual, found.known[than].residual)
    ]
    return left[1] > (1 - policy.matters) * left[0]


def all_alike(found: Searched, chosen: EffectSet, policy: Policy) -> list[EffectSet]:
    """The sets of a set's size that may stand in its place: itself, then those that are worth most.

    Of which every effect does something: one at its null stands for nothing, however little it is told from.
    """
    same = [s for s in plausible(found.known) if len(s) == len(chosen) and alike(found, chosen, s, policy)]
    same = [s for s in same if s == chosen or _all_act(found, s, policy)]
    return sorted(same, key=lambda s: (s != chosen, -found.worths[s].total))


def _all_act(found: Searched, effects: EffectSet, policy: Policy) -> bool:
    """Whether a set leaves less, by what matters, than each of its known parts without one effect."""
    parts = [part for gone in effects if (part := effects - {gone}) in found.known]
    least = min((found.known[part].squares for part in parts), default=np.inf)
    return found.known[effects].squares <= (1 - policy.matters) * least


def alike(found: Searched, chosen: EffectSet, other: EffectSet, policy: Policy) -> bool:
    """Whether a set may stand in the chosen one's place: the confidence set of models.

    How much runs of unequal strength scatter says how unequally they speak, and is no doubt. Where most of what the
    best set leaves is not noise, only the squares speak, and frames that share an error speak as one.
    """
    if squares_judge(found.beyond_noise):
        error, least = found.known[other].residual, found.known[chosen].residual
        return surely_larger(error, least, found.likelihood.runs) <= policy.doubt
    more = found.worths[chosen].over(found.worths[other])
    return more.total <= max(policy.doubt * more.by_noise, float(np.log(policy.odds)))


def _groups(found: Searched, chosen: EffectSet, alike: Sequence[EffectSet]) -> tuple[tuple[str, ...], ...]:
    """Where a set that cannot be told apart differs in several effects, each stands for the one it looks most like."""
    groups = {effect: {effect} for effect in sorted(chosen)}
    alike_to = partial(likeness, found.likelihood, found.prospects)
    for other in alike:
        gone, new = sorted(chosen - other), sorted(other - chosen)
        table = [[alike_to(one, another) for another in new] for one in gone]
        pairs = linear_sum_assignment(np.reshape(table, (len(gone), len(new))), maximize=True)
        for row, column in zip(*pairs, strict=True):
            groups[gone[row]].add(new[column])
    return tuple(tuple(sorted(group)) for group in groups.values() if len(group) > 1)


def weights(found: Searched, chosen: EffectSet) -> dict[EffectSet, float]:
    """Of every plausible set: exp(worth), averaged over resampled runs (pseudo-BMA+; Yao et al. 2018).

    Where most of what the best set leaves is not noise: how often its squares would be the least of those that are no
    larger than the chosen one.
    """
    every = plausible(found.known)
    generator = np.random.default_rng(3)
    if squares_judge(found.beyond_noise):
        every = [s for s in every if len(s) <= len(chosen)]
        sizes = [log_squares(found.known[s].residual, found.likelihood.runs) for s in every]
        logarithms, errors = np.array(sizes).T
        drawn = logarithms + errors * generator.standard_normal((_RESAMPLED, len(every)))
        shares = np.bincount(drawn.argmin(axis=1), minlength=len(every)) / _RESAMPLED
        return dict(zip(every, map(float, shares), strict=True))
    densities = np.array([found.worths[s].densities for s in every])
    count = densities.shape[1]
    share = generator.dirichlet(np.ones(count), _RESAMPLED)
    scores = count * densities @ share.T
    scores -= scores.max(axis=0)
    weight = np.exp(scores)
    return dict(zip(every, map(float, (weight / weight.sum(axis=0)).mean(axis=1)), strict=True))


def _path(found: Searched, chosen: EffectSet) -> tuple[EffectSet, ...]:
    """Down from the chosen set, each time without the effect that is missed least, by way of sets that were fitted."""
    path = [chosen]
    while path[0]:
        smaller = [path[0] - {effect} for effect in path[0]]
        fitted = [s for s in smaller if s in found.known]
        path.insert(0, max(fitted, key=lambda s: found.worths[s].total) if fitted else NOTHING)
    return tuple(path)
