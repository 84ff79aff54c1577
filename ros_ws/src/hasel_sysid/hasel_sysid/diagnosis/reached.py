"""The sum of squares by which every effect is judged."""

from collections.abc import Mapping, Sequence

from hasel_sysid.diagnosis.trial import Trial
from hasel_sysid.estimation.result import FitResult


def squares_reached(
    trials: Sequence[Trial], finals: Mapping[str, FitResult], base: float, hurried: bool
) -> dict[str, float]:
    """What each effect has reached, by its id: in its full fit, or else on the draft.

    base: without any effect; hurried: no time was left for all steps and full fits. What has none is then judged by
    what it promises: it is not the worse explanation for not having had its turn.
    """
    squares = {}
    for trial in trials:
        reached = min(trial.predicted, trial.sum_of_squares)
        if hurried:
            reached = min(reached, max(0.0, base - trial.promised))
        squares[trial.start.effect.id] = reached
    return squares | {effect: final.evaluation.sum_of_squares for effect, final in finals.items()}
