"""Two effects at once, where none alone is an explanation."""

from itertools import combinations

import numpy as np
from hasel_sim.errors import HaselSimError

from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.context import plausible
from hasel_sysid.diagnosis.explained import EXPLAINED, share_left
from hasel_sysid.diagnosis.significance import drops
from hasel_sysid.fit import FitResult, fit_least_squares
from hasel_sysid.improve.exchange import with_effect
from hasel_sysid.improve.result import Stage
from hasel_sysid.problem import Problem
from hasel_sysid.projection import orthonormal

_FITTED = 2
"""How many pairs are fitted in full."""
_PROMISING = 0.6
"""Share of the error above the noise (sum of squares) that a pair worth fitting promises to remove."""


def explaining_pair(problem: Problem, stage: Stage) -> FitResult | None:
    """The stage's model with two more effects that explain together what it leaves; None if no two are found that do.

    Two effects that hide each other's trace are missed by adding one after the other. Only an explanation is good
    enough: of any two effects one may hope that they imitate a little of anything.
    """
    found = stage.diagnosis
    for pair in promising_pairs(found)[:_FITTED]:
        model = stage.fit.model
        try:
            for effect in pair:
                model = with_effect(model, found, effect)
            fit = fit_least_squares(problem, model, drafts=False)
        except HaselSimError:
            continue
        left = share_left(stage.fit.mean_absolute_error, fit.mean_absolute_error, found.noise.mean_absolute)
        both_plausible = len(plausible(dict.fromkeys(pair, fit), stage.fit)) == len(pair)
        if both_plausible and left <= 1 - EXPLAINED:
            return fit
    return None


def promising_pairs(found: Diagnosis) -> list[tuple[str, str]]:
    """Pairs of effects that by their signatures could remove most of the error above the noise, best first.

    Effects that look alike make no pair.
    """
    context = found.context
    evaluation = context.fit.evaluation
    imitable = orthonormal(evaluation.jacobian)
    promised = {}
    for pair in combinations(context.signatures, 2):
        if not any(set(pair) <= set(group) for group in found.groups):
            columns = np.column_stack([context.signatures[effect].columns for effect in pair])
            promised[pair] = float(drops(columns, imitable, evaluation.residual))
    enough = [pair for pair, drop in promised.items() if drop >= _PROMISING * context.excess]
    return sorted(enough, key=lambda pair: -promised[pair])
