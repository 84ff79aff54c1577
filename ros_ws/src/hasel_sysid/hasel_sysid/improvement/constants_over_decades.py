"""Constants of a model file over their ranges: beside a model that is far off, first order leads to none of them."""

from collections.abc import Iterator, Sequence

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
    looks = [look for evaluation in begun for look in _two_steps_on(problem, evaluation, policy)]
    best: dict[str, Look] = {}
    for look in most_promising(looks, (1 - policy.effort.hope) * begun[0].sum_of_squares):
        best.setdefault(look.name, look)
    return list(best.values())


def _two_steps_on(problem: Problem, begun: Evaluation, policy: Policy) -> list[Look]:
    trials = Trials(problem, begun)
    correction = begun.residual - trials.base.residual
    looks = one_step_on(problem, trials.model, _nearest(trials), correction)
    best = sorted(looks, key=lambda look: look.squares)[: policy.effort.trials]
    if trials.time_is_over():
        return []
    return one_step_on(problem, trials.model, best, correction)


def _nearest(trials: Trials) -> list[Look]:
    """Every constant that comes nearer somewhere, where it does so most; all that was fitted is left as it is."""
    fitted = {name: trials.fitted.model.values[name] for name in trials.fitted.names}
    best: dict[str, Look] = {}
    for name, value, left in _seen(trials):
        if name not in best or left < best[name].squares:
            best[name] = Look(name, {**fitted, name: value}, left)
    return most_promising(list(best.values()), left_beyond(trials.fitted.residual, trials))


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
