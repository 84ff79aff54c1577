# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The answer among fitted models: the smallest one that predicts left-out runs as well as the best.

One-standard-error rule: Breiman et al. 1984. What cannot be told from the answer is its model confidence set (Hansen,
Lunde and Nason 2011), by the error of a log-likelihood ratio (Vuong 1989). Weights: pseudo-BMA+ (Yao et al. 2018).
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import takewhile

import numpy as np
from scipy.optimize import linear_sum_assignment

from hasel_sysid.policy import Policy
from hasel_sysid.selection.cross_validation import Elpd
from hasel_sysid.selection.likelihood import NOTHING, FittedSet, Names, Whitened

_RESAMPLED = 2000


@dataclass(frozen=True, eq=False)
class Judged:
    """A fitted model in the one currency. elpd: of its left-out runs; whitened: its residual."""

    fitted: FittedSet
    whitened: Whitened
    elpd: Elpd


Models = Mapping[Names, Judged]
Excused = Callable[[Names, np.ndarray], bool]
"""Of a set, and how a larger one changes its residual [frames]."""


@dataclass(frozen=True)
class Choice:
    """chosen: the set to take; rivals: sets of its size that cannot be told from it, itself among them; weights: of
    every model, together one; path: from no candidate to the chosen set, one more at a time; groups: for every chosen
    candidate for which there are such, those that may stand in its place, itself among them; no_laws: sets that would
    have been taken, were they laws.
    """

    chosen: Names
    rivals: tuple[Names, ...]
    weights: dict[Names, float]
    path: tuple[Names, ...]
    groups: tuple[tuple[str, ...], ...]
    no_laws: tuple[Names, ...] = ()

    def weight_of(self, name: str) -> float:
        """Of all sets with a candidate."""
        return sum(weight for names, weight in self.weights.items() if name in names)

    @property
    def in_order(self) -> tuple[str, ...]:
        """The chosen candidates in the order in which the path takes them in."""
        order: list[str] = []
        for step in self.path:
            order += sorted(step - set(order))
        return tuple(order)


def choose(
    models: Models,
    policy: Policy,
    threshold: float,
    excused: Excused,
    likeness: Callable[[str, str], float],
    is_law: Callable[[Names], bool],
) -> Choice:
    """threshold: of log-likelihood, that noise alone makes of the best of all candidates; excused: whether what no
    model has may be all that a set lacks; likeness: of two candidates, 0 to 1; is_law: whether what a set adds has one
    value in every run.

    Of models that cannot be told apart the first that is a law stands in the place of the others; where none is, the
    best stays.
    """
    best = smallest(models, policy, threshold, excused)
    rivals = confidence_set(models, best, policy)
    no_laws = tuple(takewhile(lambda names: not is_law(names), rivals))
    if len(no_laws) == len(rivals):
        no_laws = ()
    chosen, same = rivals[len(no_laws)], [names for names in rivals if names not in no_laws]
    return Choice(
        chosen, tuple(same), weights(models), _path(models, chosen), _groups(chosen, same, likeness), no_laws
    )


def plausible(models: Models) -> list[Names]:
    """The sets, the empty one among them, whose values lie inside their ranges."""
    return [names for names, one in models.items() if one.fitted.plausible]


def best_of(models: Models) -> Names:
    """The set that predicts best, of those with plausible values."""
    return max(plausible(models), key=lambda names: models[names].elpd.total)


def smallest(models: Models, policy: Policy, threshold: float, excused: Excused) -> Names:
    """The smallest set within one standard error of the best; and no candidate stays whose removal, refitted, costs
    less than that, or less than noise alone makes of the best of all candidates, or is excused (backward check).
    """
    best = best_of(models)
    as_good = [n for n in plausible(models) if not is_better(models, best, n, policy)]
    found = min(as_good, key=lambda names: (len(names), -models[names].elpd.total))
    while parts := [
        part
        for part in _parts(models, found)
        if not _is_needed(models, found, part, policy, threshold, excused)
    ]:
        found = max(parts, key=lambda names: models[names].elpd.total)
    return found


def is_better(models: Models, one: Names, other: Names, policy: Policy) -> bool:
    """Whether one set predicts left-out runs better than another, by more than the error of the difference."""
    return models[one].elpd.over(models[other].elpd).exceeds(policy.standard_errors)


def _is_needed(
    models: Models, whole: Names, part: Names, policy: Policy, threshold: float, excused: Excused
) -> bool:
    """Whether it is likelier, predicts better, and the part alone is not excused: what no model has is the same in
    every run, where a likelihood takes it for independent.
    """
    gain = models[whole].whitened.logarithm - models[part].whitened.logarithm
    better = gain > threshold * len(whole - part) and is_better(models, whole, part, policy)
    change = models[whole].fitted.residual - models[part].fitted.residual
    return better and not excused(part, change)


def _parts(models: Models, names: Names) -> list[Names]:
    """The fitted sets that lack one of these."""
    return [part for gone in names if (part := names - {gone}) in models and models[part].fitted.plausible]


def confidence_set(models: Models, chosen: Names, policy: Policy) -> list[Names]:
    """The sets of a set's size that may stand in its place: itself first, then those that predict best.

    Of which no candidate is there for nothing; a value on the edge of its range comes after values inside, and a
    constant of the file, which somebody measured, after effects.
    """
    same = [
        n for n in plausible(models) if len(n) == len(chosen) and _may_stand_for(models, chosen, n, policy)
    ]
    return sorted(
        same,
        key=lambda n: (
            models[n].fitted.on_edge,
            models[n].fitted.has_constant,
            n != chosen,
            -models[n].elpd.total,
        ),
    )


def _may_stand_for(models: Models, chosen: Names, other: Names, policy: Policy) -> bool:
    if other == chosen:
        return True
    if any(not is_better(models, other, part, policy) for part in _parts(models, other)):
        return False
    more = models[chosen].elpd.over(models[other].elpd)
    return more.total <= max(policy.confidence * more.by_noise, float(np.log(policy.odds)))


def _groups(
    chosen: Names, rivals: Sequence[Names], likeness: Callable[[str, str], float]
) -> tuple[tuple[str, ...], ...]:
    """Where a rival differs in several candidates, each stands for the one it looks most like."""
    groups = {name: {name} for name in sorted(chosen)}
    for other in rivals:
        gone, new = sorted(chosen - other), sorted(other - chosen)
        table = [[likeness(one, another) for another in new] for one in gone]
        pairs = linear_sum_assignment(np.reshape(table, (len(gone), len(new))), maximize=True)
        for row, column in zip(*pairs, strict=True):
            groups[gone[row]].add(new[column])
    return tuple(tuple(sorted(group)) for group in groups.values() if len(group) > 1)


def weights(models: Models) -> dict[Names, float]:
    """Of every plausible set: exp(elpd), averaged over resampled runs."""
    every = plausible(models)
    densities = np.array([models[names].elpd.densities for names in every])
    count = densities.shape[1]
    share = np.random.default_rng(3).dirichlet(np.ones(count), _RESAMPLED)
    scores = count * densities @ share.T
    scores -= scores.max(axis=0)
    weight = np.exp(scores)
    return dict(zip(every, map(float, (weight / weight.sum(axis=0)).mean(axis=1)), strict=True))


def _path(models: Models, chosen: Names) -> tuple[Names, ...]:
    """Down from the chosen set, each time without the candidate that is missed least."""
    path = [chosen]
    while path[0]:
        fitted = [part for gone in path[0] if (part := path[0] - {gone}) in models]
        path.insert(0, max(fitted, key=lambda names: models[names].elpd.total) if fitted else NOTHING)
    return tuple(path)


@dataclass(frozen=True)
class ComparedModel:
    """A row of the table of models, as ArviZ' `compare` prints it. difference, error: of elpd to the best model's;
    status: chosen, rival, or why it is not; parameters: what its candidates came to.
    """

    effects: tuple[str, ...]
    elpd: float
    difference: float
    error: float
    weight: float
    status: str
    parameters: dict[str, float]

    def __str__(self) -> str:
        name = " + ".join(self.effects) or "baseline"
        numbers = f"{self.elpd:10.1f} {self.difference:9.1f} {self.error:7.1f} {self.weight:7.2f}"
        return f"{name:44s} {numbers}  {self.status}"


TABLE_HEAD = f"{'model':44s} {'elpd':>10s} {'elpd_diff':>9s} {'dse':>7s} {'weight':>7s}  status"


def compare(models: Models, choice: Choice) -> tuple[ComparedModel, ...]:
    """Every fitted model, best first."""
    best = best_of(models)
    rows = []
    for names in sorted(models, key=lambda n: -models[n].elpd.total):
        one = models[names]
        difference = models[best].elpd.over(one.elpd)
        rows.append(
            ComparedModel(
                tuple(sorted(names)),
                one.elpd.total,
                difference.total,
                difference.error,
                choice.weights.get(names, 0.0),
                _status(names, one, choice),
                {n: one.fitted.fit.model.values[n] for c in one.fitted.candidates.values() for n in c.names},
            )
        )
    return tuple(rows)


def _status(names: Names, one: Judged, choice: Choice) -> str:
    if names == choice.chosen:
        return "chosen"
    if names in choice.no_laws:
        return "not one law for all runs"
    if names in choice.rivals:
        return "cannot be told from it"
    if not one.fitted.plausible:
        return "out of its plausible range"
    return "larger than needed" if len(names) > len(choice.chosen) else "predicts worse"
