"""Where effects are looked at beside a set, from what they did beside the baseline."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hasel_sysid.diagnosis.candidates import Start, resized
from hasel_sysid.diagnosis.trial import Trial
from hasel_sysid.policy import POLICY
from hasel_sysid.projection import orthonormal
from hasel_sysid.selection.sets import FittedSet

_SIZES = (0.1, 2.0)
"""Smallest and largest start, in typical sizes."""


@dataclass(frozen=True, eq=False)
class Expected:
    """Of an effect beside a set; trial: of it beside the baseline; change [frames]: that it made there; sized: a start
    of the size to be expected; begin: where it is looked at first, as large, or without effect.
    """

    trial: Trial
    change: np.ndarray
    sized: Start
    begin: Start


def expected_beside(of: FittedSet, first: Sequence[Trial], baseline: np.ndarray) -> list[Expected]:
    """The best start of every effect, of the size that its change beside the baseline leads to expect beside a set.

    Where first order leads back to no effect, it starts without: one simulation serves all of those.
    first: trials beside the baseline, whose residual is `baseline` [frames].
    """
    basis = orthonormal(of.jacobian)
    best: dict[str, tuple[float, Expected]] = {}
    for trial in first:
        effect = trial.start.effect.id
        change = baseline - trial.residual
        left = change - basis @ (basis.T @ change)
        power, along = float(left @ left), float(left @ of.residual)
        drop = along * abs(along) / power if power > 0 else 0.0
        if effect not in best or drop > best[effect][0]:
            size = float(np.clip(along / power, *_SIZES)) if power > 0 else 1.0
            sized = resized(trial.start, size)
            begin = trial.start.without_effect() if _leads_back(trial, change) else sized
            best[effect] = drop, Expected(trial, change, sized, begin)
    return [one for _, one in best.values()]


def overlooked(every: Sequence[Expected], seen: Sequence[Trial]) -> list[Start]:
    """Starts of the size to be expected of what was looked at without effect, where that shows too little of it.

    Derivatives that make less of the typical size than half of what it changed beside the baseline are as good as
    blind, as those of a lag behind the slowest rise. More than that is no harm: it is seen.
    seen: trials beside the set.
    """
    at_null = {trial.start.effect.id: trial for trial in seen if trial.start.changes_nothing}
    found = []
    for one in every:
        null = at_null.get(one.begin.effect.id)
        if null is None or one.sized.changes_nothing:
            continue
        shown = np.linalg.norm(_foretold(null, one.trial.start))
        if shown < POLICY.effort.hope * np.linalg.norm(one.change):
            found.append(one.sized)
    return found


def _leads_back(trial: Trial, change: np.ndarray) -> bool:
    """Whether a trial's derivatives lead back to no effect: they miss less of its change [frames] than a promise may.

    Not less of it for a smaller size: beside a baseline that is far off, the size to be expected is hardly known.
    """
    missed = np.linalg.norm(change - _foretold(trial, trial.start))
    return bool(missed <= POLICY.effort.hope * np.linalg.norm(change))


def _foretold(by: Trial, start: Start) -> np.ndarray:
    """What the derivatives of a trial make of the sizes at which the effect starts, [frames]."""
    found = np.zeros(len(by.residual))
    for name, null in start.nulls.items():
        found += by.jacobian[:, by.names.index(name)] * (start.values[name] - null)
    return found
