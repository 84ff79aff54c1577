"""Which effects can be in one model."""

from collections.abc import Iterable, Sequence

from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.candidates import Start


def go_together(effects: Iterable[Effect]) -> bool:
    """Whether each is there once, and no two of them do the same."""
    words = [word for effect in effects for word in (effect.id, effect.exclusive) if word]
    return len(words) == len(set(words))


def side_by_side(starts: Sequence[Start]) -> list[list[Start]]:
    """Starts in groups whose effects go together, each in the first group that has room for it."""
    groups: list[list[Start]] = []
    for start in starts:
        for group in groups:
            if go_together(own.effect for own in (*group, start)):
                group.append(start)
                break
        else:
            groups.append([start])
    return groups
