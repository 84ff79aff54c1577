"""Second thoughts: with a later effect in the model, are the earlier ones still needed?"""

from collections.abc import Sequence

from hasel_sim.errors import HaselSimError

from hasel_sysid.fit import FitResult, fit_least_squares
from hasel_sysid.improve.decision import LEAST_GAIN
from hasel_sysid.problem import Problem


def pruned(problem: Problem, fit: FitResult, earlier: Sequence[str]) -> FitResult:
    """The fit without those of the earlier effects that lower its sum of squares by no more than a trifle.

    What seemed to be missing may have stood in for the one that was found later.
    """
    present = {effect.id for effect in fit.model.effects}
    for effect in earlier:
        if effect not in present:
            continue
        try:
            without = fit_least_squares(
                problem, fit.model.without_effects(effect), most_evaluations=8, drafts=False
            )
        except HaselSimError:
            continue
        if 1 - fit.evaluation.sum_of_squares / without.evaluation.sum_of_squares < LEAST_GAIN:
            fit = without
    return fit
