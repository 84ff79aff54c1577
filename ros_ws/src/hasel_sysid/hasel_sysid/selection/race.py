# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Every candidate alone, fitted by the low-fidelity model until it converged or can no longer win.

Racing: Maron and Moore, Advances in Neural Information Processing Systems 6 (1994) 59. Typical sizes take part first,
of which first order foretells which may win. Where something is still missing, all other sizes take part.
"""

from collections.abc import Sequence

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.candidates import Candidate
from hasel_sysid.estimation.fit import TOLERANCE, descend
from hasel_sysid.estimation.least_squares import OPTIMISM, GaussNewton, best_of_each, step_together
from hasel_sysid.estimation.starts import MOST_FOLLOWED, Screened, screen, starts
from hasel_sysid.problem import Evaluation, LowFidelityProblem
from hasel_sysid.selection.likelihood import Likelihood

_RUNS = 2
"""Runs on which other than typical sizes take part, those of which most is left: the ends they lead to are fitted to
all runs after.
"""
_OF_EACH = 3
"""Starts of one candidate at most that take part."""

Entries = Sequence[tuple[str, Model]]
"""The name of a candidate, and the model with it where it begins."""


def screen_typical(
    problem: LowFidelityProblem, candidates: Sequence[Candidate]
) -> tuple[list[Screened], list[Candidate]]:
    """Every candidate once at its typical size, at all times and places; and those for which there was no time."""
    found: list[Screened] = []
    left = list(candidates)
    for batch in problem.time_limit.in_batches(candidates, even_late=True):
        found += screen(problem, problem.known, [s for c in batch for s in starts(c) if s.typical])
        left = left[len(batch) :]
    return found, left


def candidates_of(screened: Sequence[Screened]) -> dict[str, Candidate]:
    """The candidates that were simulated, by name."""
    return {one.start.candidate.name: one.start.candidate for one in screened}


def at_typical_size(problem: LowFidelityProblem, typical: Sequence[Screened], to_beat: float) -> Entries:
    """Those of the candidates screened that may win, by twice what first order promises; the likeliest come first.

    to_beat: sum of squares that a model leaves which is known already.
    """
    about = problem.known.sum_of_squares
    ranked = sorted(typical, key=lambda one: one.predicted)
    best = min([to_beat, *(one.predicted for one in ranked)])
    able = [one for one in ranked if about - OPTIMISM * (about - one.predicted) <= best]
    return [_entry(problem, one) for one in _some_of_each(able)[:MOST_FOLLOWED]]


def at_other_sizes(problem: LowFidelityProblem, typical: Sequence[Screened], most: int) -> Entries:
    """The candidates that a fit from other than typical sizes brings furthest, at most so many, and where they came to.

    typical: what `screen_typical` found. Every size is simulated, and the most promising of each candidate are fitted,
    on the runs of which most is left: further from the null than the typical one, and nearer to it where that changes
    more than what is to be explained.
    """
    about = problem.known
    worst = np.argsort(-np.bincount(about.runs, about.residual**2))[:_RUNS].tolist()
    few = problem.of_runs(worst)
    strong = {one.start.candidate.name for one in typical if one.strength > 1.0}
    others = [
        start
        for name, candidate in candidates_of(typical).items()
        for start in starts(candidate)
        if not start.typical and (abs(start.factor) >= 1.0 or name in strong)
    ]
    screened: list[Screened] = []
    for batch in problem.time_limit.in_batches(others):
        screened += screen(few, few.known, batch)
    entries = [_entry(few, one) for one in _some_of_each(sorted(screened, key=lambda one: one.predicted))]
    if problem.time_limit.is_over():
        return []
    names = {frozenset(model.free): name for name, model in entries}
    ended: dict[str, Model] = {}
    for one in descend(few, [model for _, model in entries], about.names, may_win=best_of_each(most)):
        ended.setdefault(names[frozenset(one.model.free)], one.model)
    return list(ended.items())[:most]


def race(
    problem: LowFidelityProblem, entries: Entries, likelihood: Likelihood, reach: float
) -> dict[str, Evaluation]:
    """The best low-fidelity model with each of the candidates, by name: one Gauss-Newton step each, of those that can
    still win.

    problem: corrected at the model without any of them; reach: by how much of log-likelihood a model may lie behind the
    best one and still be its equal.
    """
    about = problem.known
    base = likelihood.of(about.residual, about.jacobian).logarithm
    begun = problem.evaluate_each([model for _, model in entries], [model.free for _, model in entries])
    searches = {
        GaussNewton(seen, TOLERANCE, _first(seen, about)): name
        for (name, _), seen in zip(entries, begun, strict=True)
        if not isinstance(seen, SimulationError)
    }

    def may_win(every: Sequence[GaussNewton]) -> list[bool]:
        if problem.time_limit.is_over():
            return [False] * len(every)
        gains = [likelihood.of(s.at.residual, s.at.jacobian).logarithm - base for s in every]
        return [OPTIMISM * gain >= max(gains) - reach for gain in gains]

    step_together(problem, list(searches), may_win)
    ended: dict[str, Evaluation] = {}
    for search in sorted(searches, key=lambda one: one.at.sum_of_squares):
        ended.setdefault(searches[search], search.at)
    return ended


def _entry(problem: LowFidelityProblem, one: Screened) -> tuple[str, Model]:
    candidate = one.start.candidate
    return candidate.name, candidate.added_to(problem.known.model).with_values(one.values())


def _some_of_each(ranked: Sequence[Screened]) -> list[Screened]:
    taken: list[Screened] = []
    for one in ranked:
        if sum(other.start.candidate.name == one.start.candidate.name for other in taken) < _OF_EACH:
            taken.append(one)
    return taken


def _first(begun: Evaluation, about: Evaluation) -> Sequence[str]:
    """What follows alone at first: all that was fitted, where a start alone makes things worse."""
    return about.names if begun.sum_of_squares > about.sum_of_squares else ()
