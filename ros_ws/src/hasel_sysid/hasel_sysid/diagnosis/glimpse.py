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
    """Of every effect the start that comes nearest to what was measured, where no trial of it comes as near, and it
    comes nearer by a good part of what the nearest of all does. made: trials of any effects.
    """
    every: list[Glimpse | Trial] = [*seen, *made]
    left = {one: left_beyond(one.residual, trials) for one in every}
    without = left_beyond(trials.fitted.residual, trials)
    most = without - min(left.values(), default=without)
    found = []
    for effect in dict.fromkeys(one.start.effect.id for one in seen):
        nearest = min((one for one in seen if one.start.effect.id == effect), key=left.__getitem__)
        known = [left[trial] for trial in made if trial.start.effect.id == effect]
        hoped = without - left[nearest] >= POLICY.effort.hope * most
        if hoped and left[nearest] < min(known, default=np.inf):
            found.append(nearest.start)
    return found


def left_beyond(residual: np.ndarray, trials: Trials) -> float:
    """Squares that are left beyond what the model imitates, and what a larger or smaller motion in any run makes of it:
    beside a model that is far off, the muscles are as wrong as what is missing.
    """
    simulated, runs = trials.fitted.measured() - residual, trials.fitted.runs
    scaled = [np.where(runs == run, simulated, 0.0) for run in np.unique(runs)]
    beyond = residual - trials.imitable @ (trials.imitable.T @ residual)
    return float(beyond @ beyond - drops(np.column_stack(scaled), trials.imitable, residual))
