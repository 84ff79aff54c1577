# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The first-order log-likelihood of every compatible set of a few candidates: best subset selection.

Furnival and Wilson, Technometrics 16 (1974) 499; Bertsimas, King and Mazumder, Annals of Statistics 44 (2016) 813. Made
iterative by linearising anew about the likeliest model.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from hasel_sysid.candidates import compatible
from hasel_sysid.estimation.least_squares import bounded_change
from hasel_sysid.selection.likelihood import NOTHING, FittedSet, Likelihood, Names
from hasel_sysid.selection.linearise import CandidateColumns, own_columns, room

_SHORTLIST = 40
"""Sets that are ranked with the bounds of their parameters; all others without."""


@dataclass(frozen=True, eq=False)
class Row:
    """A set of candidates. logarithm: of its likelihood, to first order; values: where its fit begins, by name."""

    names: Names
    logarithm: float
    values: dict[str, float]


def best_subsets(
    about: FittedSet,
    columns: Mapping[str, CandidateColumns],
    likelihood: Likelihood,
    most: int,
    penalty: float,
    holding: Names = NOTHING,
) -> list[Row]:
    """The most promising sets of up to `most` candidates, by log-likelihood less a penalty for each of them.

    columns: of every candidate that `about` has not, beside it; holding: what every set has to have.
    """
    parts = {**columns, **{name: own_columns(about, name) for name in about.names}}
    names = sorted(parts)
    sizes = [parts[name].jacobian.shape[1] for name in names]
    slots = dict(zip(names, np.split(np.arange(sum(sizes)), np.cumsum(sizes)[:-1]), strict=True))
    own = {n for c in about.candidates.values() for n in c.names}
    base = [name for name in about.moving if name not in own]
    bare = about.residual + sum((parts[n].change for n in about.names), start=np.zeros_like(about.residual))
    white = likelihood.whiten(
        np.column_stack([bare, about.fit.evaluation.by(base).jacobian, *(parts[n].jacobian for n in names)])
    )
    basis = np.linalg.qr(white[:, 1 : 1 + len(base)])[0]
    residual, tail = (x - basis @ (basis.T @ x) for x in (white[:, 0], white[:, 1 + len(base) :]))
    gram, score, squares = tail.T @ tail, tail.T @ residual, float(residual @ residual)
    gram = gram + 1e-12 * np.trace(gram) * np.eye(len(gram))

    def unbounded(group: tuple[str, ...]) -> float:
        slot = np.concatenate([slots[name] for name in group]).astype(int) if group else np.zeros(0, int)
        gain = score[slot] @ np.linalg.solve(gram[np.ix_(slot, slot)], score[slot]) if len(slot) else 0.0
        return -0.5 * (squares - float(gain)) - penalty * len(group)

    every = [
        group
        for size in range(most + 1)
        for group in combinations(names, size)
        if holding <= set(group) and compatible([parts[name].candidate for name in group])
    ]
    shortlist = sorted(every, key=lambda group: -unbounded(group))[:_SHORTLIST]
    rows = [_row(about, parts, base, frozenset(group), likelihood) for group in shortlist]
    return sorted(rows, key=lambda row: penalty * len(row.names) - row.logarithm)


def _row(
    about: FittedSet,
    parts: Mapping[str, CandidateColumns],
    base: list[str],
    names: Names,
    likelihood: Likelihood,
) -> Row:
    """A set within the bounds of its parameters."""
    stay, new = sorted(names & about.names), sorted(names - about.names)
    gone = about.names - names
    residual = about.residual + sum((parts[n].change for n in gone), start=np.zeros_like(about.residual))
    residual = residual - sum((parts[n].change for n in new), start=np.zeros_like(residual))
    model = about.fit.model
    lower, upper = room(model, base)
    chosen = [parts[n] for n in (*stay, *new)]
    jacobian = np.column_stack([about.fit.evaluation.by(base).jacobian, *(one.jacobian for one in chosen)])
    white = likelihood.whiten(np.column_stack([residual, jacobian]))
    change, squares = bounded_change(
        white[:, 0],
        white[:, 1:],
        np.concatenate([lower, *(one.lower for one in chosen)]),
        np.concatenate([upper, *(one.upper for one in chosen)]),
    )
    values = dict(model.values)
    for one in chosen:
        values |= one.values
    moved = (*base, *(name for one in chosen for name in one.names))
    values |= {name: values[name] + step for name, step in zip(moved, change, strict=True)}
    return Row(names, -0.5 * squares, values)
