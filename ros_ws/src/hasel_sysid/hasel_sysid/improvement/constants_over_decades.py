"""Constants of a model file over their ranges: beside a model that is far off, first order leads to none of them."""

from collections.abc import Iterator, Sequence

import numpy as np
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.diagnosis.glimpse import left_beyond
from hasel_sysid.diagnosis.trial import Trials
from hasel_sysid.estimation.decades import decades
from hasel_sysid.improvement.constant_look import Look, most_promising, one_step_on
from hasel_sysid.improvement.freed_constant import freed, held_constants, is_possible
from hasel_sysid.policy import Policy
from hasel_sysid.problem import Evaluation, Problem


def over_decades(problem: Problem, begun: Sequence[Evaluation], policy: Policy) -> list[Look]:
    """Looks at the constants that promise to take away a good part of what a model leaves, two steps on from where each
    comes nearest to what was measured; most promising first.

    begun: the model as fitted, and with other values of the same parameters: where it is far off, its fit may have
    taken them further away from the truth than they were.
    """
    every = [Trials(problem, evaluation) for evaluation in begun]
    worst = _worst_run(begun[0])
    first = [_further(trials, _nearest(_of_one_run(trials, worst))) for trials in every]
    best = _best_of_each([look for looks in first for look in looks])[: policy.effort.trials]
    if problem.time_limit.is_over():
        return []
    going_on = [[look for look in looks if look in best] for looks in first]
    second = [_further(trials, looks) for trials, looks in zip(every, going_on, strict=True)]
    reached = _best_of_each([look for looks in second for look in looks])
    return most_promising(reached, (1 - policy.effort.hope) * begun[0].sum_of_squares)


def _worst_run(evaluation: Evaluation) -> int:
    """The run of which most is left: a constant that is what is wrong does most there."""
    return int(np.bincount(evaluation.runs, evaluation.residual**2).argmax())


def _of_one_run(trials: Trials, number: int) -> Trials:
    """The same beside one of the runs."""
    alone = trials.problem.with_experiments([trials.problem.experiments[number]])
    return Trials(alone, alone.evaluate(trials.fitted.model, trials.fitted.names))


def _further(trials: Trials, looks: Sequence[Look]) -> list[Look]:
    """One step on, all runs simulated."""
    correction = trials.fitted.residual - trials.base.residual
    return one_step_on(trials.problem, trials.model, looks, correction)


def _best_of_each(looks: Sequence[Look]) -> list[Look]:
    """The most promising look at every constant, the best first."""
    best: dict[str, Look] = {}
    for look in sorted(looks, key=lambda look: look.squares):
        best.setdefault(look.name, look)
    return list(best.values())


def _nearest(trials: Trials) -> list[Look]:
    """Every constant that comes nearer somewhere, where it does so most; all that was fitted is left as it is."""
    fitted = {name: trials.fitted.model.values[name] for name in trials.fitted.names}
    looks = [Look(name, {**fitted, name: value}, left) for name, value, left in _seen(trials)]
    return most_promising(_best_of_each(looks), left_beyond(trials.fitted.residual, trials))


def _seen(trials: Trials) -> Iterator[tuple[str, float, float]]:
    """Every constant's values that can be simulated, as long as there is time, with the squares left there."""
    places = [(name, there) for name in held_constants(trials.model) for there in _places(trials.model, name)]
    for batch in trials.problem.time_limit.in_batches(places):
        found = trials.problem.evaluate_each([there for _, there in batch], [()] * len(batch))
        for (name, there), seen in zip(batch, found, strict=True):
            if not isinstance(seen, SimulationError):
                yield name, there.values[name], left_beyond(trials.corrected(seen), trials)


def _places(model: Model, name: str) -> Iterator[Model]:
    free = freed(model, name)
    for value in decades(free, name):
        there = free.with_values({name: value})
        if is_possible(there, name):
            yield there
