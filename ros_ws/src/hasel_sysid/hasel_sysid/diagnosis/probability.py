"""How probable it is that each effect, or none of them, is the missing one."""

import numpy as np

from hasel_sysid.diagnosis.context import SIGNIFICANT, Context


def probabilities(context: Context) -> tuple[dict[str, float], float]:
    """Probability of each effect being the missing one, and of none of them.

    Weights exp(-(S - S_best) / t), t twice the noise's variance in the direction of a typical signature (which
    correlated noise makes larger than that of a frame) and a hundredth of the squares above the noise, since no model
    is exact; half a logarithm of the frames per parameter is taken off, as BIC does. S is that of the full fit, or of
    the draft where there is none. An effect whose full fit is refuted weighs nothing while another stands. What the
    best leaves above the noise counts for "none of them".
    """
    standing = context.squares
    if context.winner is not None:
        standing = [name for name in context.squares if name not in context.refuted]
    scores = {name: context.score(name) for name in standing}
    nothing = -context.base / context.tolerance
    best = max([nothing, *scores.values()])
    weights = {name: float(np.exp(score - best)) for name, score in scores.items()}
    weight_nothing = float(np.exp(nothing - best))
    unexplained = 1 - max((context.removed(name) for name in scores), default=0.0)
    some = context.chance < SIGNIFICANT
    none = float(np.clip((unexplained - 0.05) / 0.3, 0.0, 1.0)) if some else 1.0
    total = sum(weights.values()) + weight_nothing
    share = 1 - none if some else 0.0
    return {
        name: share * weights.get(name, 0.0) / total for name in context.signatures | context.squares
    }, none
