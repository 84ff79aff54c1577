"""Which effects these recordings cannot tell apart."""

import numpy as np

from hasel_sysid.diagnosis.context import Context
from hasel_sysid.diagnosis.signature import alike

_ALIKE = 0.95
_TOLD_APART = 0.03
"""Two effects whose refits differ by less than this share of the excess are not told apart: no model is that exact."""


def groups(context: Context) -> list[tuple[str, ...]]:
    """Groups of effects that these recordings cannot tell apart, the winner's first.

    The winner's partners are those whose fit comes as close as the noise and a small share of the excess allow; other
    pairs are judged by how alike what they leave is.
    """
    found: list[set[str]] = []
    winner = context.winner
    if winner is not None:
        slack = 6 * context.directional_variance + _TOLD_APART * context.excess
        partners = {n for n, s in context.squares.items() if s - context.squares[winner] <= slack}
        found.append(partners | {winner})
    names = [
        name for name, seen in context.signatures.items() if np.any(seen.left) and seen.swallowed < 0.999
    ]
    for index, one in enumerate(names):
        for other in names[index + 1 :]:
            if alike(context.signatures[one], context.signatures[other]) > _ALIKE:
                _join(found, {one, other}, keep_first=winner is not None)
    return [tuple(sorted(group)) for group in found if len(group) > 1]


def _join(found: list[set[str]], pair: set[str], keep_first: bool) -> None:
    for group in found[1 if keep_first else 0 :]:
        if group & pair:
            group |= pair
            return
    found.append(pair)
