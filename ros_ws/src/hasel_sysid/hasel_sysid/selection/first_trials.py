"""The first trials of effects: over their ranges beside the baseline, beside other sets of the size to be expected."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeVar

import numpy as np
from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.candidates import Start, resized, starts
from hasel_sysid.diagnosis.glimpse import glimpses
from hasel_sysid.diagnosis.trial import Trial, Trials, nearer
from hasel_sysid.policy import POLICY
from hasel_sysid.projection import orthonormal
from hasel_sysid.selection.decade_trials import decade_trials
from hasel_sysid.selection.sets import FittedSet

Seen = TypeVar("Seen")

_BATCH = 8
_SIZES = (0.1, 2.0)
"""Smallest and largest start, in typical sizes."""


def first_trials(trials: Trials, effects: Sequence[Effect], decades: bool) -> list[Trial]:
    """Beside the baseline; decades: also at sizes over the decades of every range.

    What starts without effect, or else the first batch, is tried in any case.
    """
    typical = [start for effect in effects for start in starts(effect)]
    found = trials.first([start for start in typical if start.changes_nothing])
    tried = partial(_in_batches, trials, trials.first)
    found += tried([start for start in typical if not start.changes_nothing], even_late=not found)
    found += nearer(trials, typical, found)
    if decades:
        glimpsed = partial(_in_batches, trials, partial(glimpses, trials))
        found += decade_trials(trials, effects, found, glimpsed, tried)
    return found


def _in_batches(
    trials: Trials,
    see: Callable[[Sequence[Start]], list[Seen]],
    begins: Sequence[Start],
    even_late: bool = False,
) -> list[Seen]:
    """What is seen of many starts, as long as there is time; even_late: of the first batch in any case."""
    found: list[Seen] = []
    for begin in range(0, len(begins), _BATCH):
        if trials.time_is_over() and not (even_late and begin == 0):
            break
        found += see(begins[begin : begin + _BATCH])
    return found


def sized_starts(of: FittedSet, first: Sequence[Trial], baseline: np.ndarray) -> list[Start]:
    """The best start of every effect, of the size that its change beside the baseline leads to expect beside a set.

    Where first order leads back to no effect, it starts without: one simulation serves all of those.
    first: trials beside the baseline, whose residual is `baseline` [frames].
    """
    basis = orthonormal(of.jacobian)
    best: dict[str, tuple[float, Start]] = {}
    for trial in first:
        effect = trial.start.effect.id
        change = baseline - trial.residual
        left = change - basis @ (basis.T @ change)
        power, along = float(left @ left), float(left @ of.residual)
        drop = along * abs(along) / power if power > 0 else 0.0
        if effect not in best or drop > best[effect][0]:
            size = float(np.clip(along / power, *_SIZES)) if power > 0 else 1.0
            foretold = _leads_back(trial, change)
            best[effect] = drop, trial.start.without_effect() if foretold else resized(trial.start, size)
    return [start for _, start in best.values()]


def _leads_back(trial: Trial, change: np.ndarray) -> bool:
    """Whether a trial's derivatives lead back to no effect: they miss less of its change [frames] than a promise may.

    Not less of it for a smaller size: beside a baseline that is far off, the size to be expected is hardly known.
    """
    error = change.copy()
    for name, null in trial.start.nulls.items():
        error -= trial.jacobian[:, trial.names.index(name)] * (trial.start.values[name] - null)
    return bool(np.linalg.norm(error) <= POLICY.effort.hope * np.linalg.norm(change))
