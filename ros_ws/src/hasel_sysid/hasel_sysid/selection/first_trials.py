"""The first trials of effects beside the baseline, over their ranges."""

from collections.abc import Callable, Sequence
from functools import partial
from typing import TypeVar

from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.candidates import Start, starts
from hasel_sysid.diagnosis.glimpse import glimpses
from hasel_sysid.diagnosis.trial import Trial, Trials, nearer
from hasel_sysid.selection.decade_trials import decade_trials

Seen = TypeVar("Seen")


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
    return [seen for batch in trials.problem.time_limit.in_batches(begins, even_late) for seen in see(batch)]
