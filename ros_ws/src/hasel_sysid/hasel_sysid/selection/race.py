"""Every candidate alone, fitted by the low-fidelity model until it converged or can no longer win.

Racing: Maron and Moore, Advances in Neural Information Processing Systems 6 (1994) 59.
"""

from collections.abc import Sequence

import numpy as np
from hasel_sim.errors import SimulationError

from hasel_sysid.candidates import Candidate
from hasel_sysid.estimation.fit import TOLERANCE
from hasel_sysid.estimation.least_squares import MOST_STEPS, OPTIMISM, GaussNewton
from hasel_sysid.estimation.starts import MOST_FOLLOWED, Screened, Start, from_typical, screen, starts
from hasel_sysid.problem import Evaluation, LowFidelityProblem
from hasel_sysid.selection.likelihood import Likelihood

_RUNS = 4
"""Runs on which other than typical sizes are screened: those of which most is left."""
_OF_EACH = 3
"""Starts of one candidate at most that take part."""


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


def race(
    problem: LowFidelityProblem,
    typical: Sequence[Screened],
    likelihood: Likelihood,
    reach: float,
    to_beat: float = 1.0,
) -> dict[str, Evaluation]:
    """The best low-fidelity model with each of the candidates that took part, by name.

    problem: corrected at the model without any of them; typical: what `screen_typical` found; reach: by how much of
    log-likelihood a model may lie behind the best one and still be its equal; to_beat: share of the squares that
    a model leaves which is known already.
    """
    about = problem.known
    worst = np.argsort(-np.bincount(about.runs, about.residual**2))[:_RUNS].tolist()
    few = problem.of_runs(worst)
    entries = [(one.predicted / about.sum_of_squares, one) for one in typical]
    entries += _other_sizes(few, typical)
    entries.sort(key=lambda entry: entry[0])
    best = min([to_beat, *(share for share, _ in entries)])
    needed = (1.0 - best) / OPTIMISM
    able: list[Screened] = []
    for share, one in entries:
        same = sum(other.start.candidate.name == one.start.candidate.name for other in able)
        if 1.0 - share >= needed and same < _OF_EACH:
            able.append(one)
    return _run(problem, able[:MOST_FOLLOWED], likelihood, reach)


def _other_sizes(problem: LowFidelityProblem, typical: Sequence[Screened]) -> list[tuple[float, Screened]]:
    """Other sizes with the share that each promises to leave: outwards for as long as the best amount lies beyond,
    and of what acts at a place to the end; towards the null as long as the change is more than what is to be explained.
    """
    going: list[tuple[Screened, list[Start]]] = []
    for one in typical:
        for chain in from_typical(one.start.candidate):
            if chain[0].place == one.start.place:
                going.append((one, chain))
    found: list[tuple[float, Screened]] = []
    while going := [(one, chain) for one, chain in going if chain and _leads_on(one, chain[0])]:
        if problem.time_limit.is_over():
            break
        seen = screen(problem, problem.known, [chain[0] for _, chain in going])
        found += [(one.predicted / problem.known.sum_of_squares, one) for one in seen]
        of = {id(one.start): one for one in seen}
        going = [(of[id(first)], rest) for _, (first, *rest) in going if id(first) in of]
    return found


def _leads_on(one: Screened, to: Start) -> bool:
    if abs(to.factor) < abs(one.start.factor):
        return one.strength > 1.0
    return one.start.candidate.acts_at_a_place or one.amount * to.factor >= abs(to.factor)


def _run(
    problem: LowFidelityProblem,
    entries: Sequence[Screened],
    likelihood: Likelihood,
    reach: float,
) -> dict[str, Evaluation]:
    """The race itself: one Gauss-Newton step each, of those that can still win."""
    about = problem.known
    base = likelihood.of(about.residual, about.jacobian).logarithm
    models = [one.start.candidate.added_to(about.model).with_values(one.values()) for one in entries]
    begun = problem.evaluate_each(models, [model.free for model in models])
    searches = [
        (one.start.candidate.name, GaussNewton(seen, TOLERANCE, _first(seen, about)))
        for one, seen in zip(entries, begun, strict=True)
        if not isinstance(seen, SimulationError)
    ]
    for _ in range(MOST_STEPS):
        gains = [likelihood.of(s.at.residual, s.at.jacobian).logarithm - base for _, s in searches]
        needed = (max(gains, default=0.0) - reach) / OPTIMISM
        going = [
            s for gain, (_, s) in zip(gains, searches, strict=True) if gain >= needed and not s.converged
        ]
        if not going or problem.time_limit.is_over():
            break
        seen = problem.evaluate_each([s.proposal() for s in going], [s.names for s in going])
        for search, new in zip(going, seen, strict=True):
            search.take(new)
    ended: dict[str, Evaluation] = {}
    for name, search in sorted(searches, key=lambda one: one[1].at.sum_of_squares):
        ended.setdefault(name, search.at)
    return ended


def _first(begun: Evaluation, about: Evaluation) -> Sequence[str]:
    """What follows alone at first: all that was fitted, where a start alone makes things worse."""
    return about.names if begun.sum_of_squares > about.sum_of_squares else ()
