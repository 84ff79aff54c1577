"""What trials of effects on a draft of the model promise."""

from collections.abc import Mapping, Sequence

import numpy as np

from hasel_sysid.diagnosis.candidates import resized
from hasel_sysid.diagnosis.step import room
from hasel_sysid.diagnosis.trial import Trial, Trials
from hasel_sysid.selection.sets import EffectSet, Prospect, Rank

_OTHER_SIZES = (0.25, 0.5, 2.0, 4.0)
_FOLLOWED = 2
"""Of the other sizes, those whose next step promises most."""


def from_other_sizes(trials: Trials, of: Prospect) -> Prospect | None:
    """The same effect from where other sizes lead, one step on; None where it has no size to begin with."""
    start = of.start.start
    sizes = [size for factor in _OTHER_SIZES if (size := resized(start, factor)).values != start.values]
    tried = sorted(trials.first(sizes), key=lambda trial: trial.predicted)
    moved = trials.further(tried[:_FOLLOWED])
    if not moved:
        return None
    best = min(moved, key=lambda trial: trial.sum_of_squares)
    return prospect_of(best, {of.effect: looks_of(best, trials)}, of.beside)


def best_of_each(prospects: Sequence[Prospect], rank: Rank) -> list[Prospect]:
    """The best prospect of every effect, best first."""
    ranked = sorted(((rank(p), n) for n, p in enumerate(prospects)), key=lambda pair: -pair[0])
    best: dict[str, Prospect] = {}
    for _, number in ranked:
        best.setdefault(prospects[number].effect, prospects[number])
    return list(best.values())


def looks_of(trial: Trial, trials: Trials) -> np.ndarray:
    """What an effect does to the series at its first trial, and its derivatives there."""
    return np.column_stack([trials.fitted.residual - trial.residual, trial.jacobian[:, trial.is_brought]])


def prospect_of(trial: Trial, looks: Mapping[str, np.ndarray], beside: EffectSet) -> Prospect:
    """A trial as the search sees it; looks: of every effect; beside: the effects of the set that was looked beyond."""
    effect = trial.start.effect.id
    order = np.argsort(trial.is_brought, kind="stable")
    lower, upper = room(trial.model, trial.names)
    return Prospect(
        effect,
        trial.residual,
        trial.jacobian[:, order],
        len(trial.brought),
        lower[order],
        upper[order],
        looks[effect],
        beside,
        trial,
    )
