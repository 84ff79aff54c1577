"""Which effects can be in one model while none of them does anything."""

from collections.abc import Sequence

from hasel_sysid.diagnosis.candidates import Start


def side_by_side(starts: Sequence[Start]) -> list[list[Start]]:
    """Starts in groups whose effects go together, each in the first group that has room for it."""
    groups: list[list[Start]] = []
    for start in starts:
        for group in groups:
            if not any(_exclude_each_other(start, other) for other in group):
                group.append(start)
                break
        else:
            groups.append([start])
    return groups


def _exclude_each_other(one: Start, other: Start) -> bool:
    """Whether two starts are of one effect, or of effects that do the same."""
    same_kind = one.effect.exclusive == other.effect.exclusive != ""
    return one.effect.id == other.effect.id or same_kind
