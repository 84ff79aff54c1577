"""What an effect would leave at some value, without derivatives: for half the cost of a trial or less."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sim.errors import SimulationError

from hasel_sysid.diagnosis.candidates import Start
from hasel_sysid.diagnosis.trial import Trial, Trials
from hasel_sysid.policy import POLICY
from hasel_sysid.projection import drops


@dataclass(frozen=True, eq=False)
class Glimpse:
    """An effect at its start; residual: what it leaves there, corrected as a trial's [frames]."""

    start: Start
    residual: np.ndarray


def glimpses(trials: Trials, starts: Sequence[Start]) -> list[Glimpse]:
    """Of every start that can be simulated."""
    models = [trials.model_at(start) for start in starts]
    found = trials.problem.evaluate_each(models, [()] * len(models))
    return [
        Glimpse(start, trials.corrected(seen))
        for start, seen in zip(starts, found, strict=True)
        if not isinstance(seen, SimulationError)
    ]


def worth_a_trial(seen: Sequence[Glimpse], made: Sequence[Trial], trials: Trials) -> list[Start]:
    """Of every effect the start nearest to what was measured, where no trial of it is as near, and its change could
    lower the squares by a good part of what the most promising of all could. made: trials of any effects.
    """
    basis, unexplained = trials.imitable, trials.fitted.residual

    def left(one: Glimpse | Trial) -> float:
        beyond = one.residual - basis @ (basis.T @ one.residual)
        return float(beyond @ beyond)

    def promise(one: Glimpse) -> float:
        return float(drops((unexplained - one.residual)[:, None], basis, unexplained))

    most = max([*(trial.promised for trial in made), *map(promise, seen)], default=0.0)
    found = []
    for effect in dict.fromkeys(one.start.effect.id for one in seen):
        nearest = min((one for one in seen if one.start.effect.id == effect), key=left)
        known = [left(trial) for trial in made if trial.start.effect.id == effect]
        if left(nearest) < min(known, default=np.inf) and promise(nearest) >= POLICY.effort.hope * most:
            found.append(nearest.start)
    return found
