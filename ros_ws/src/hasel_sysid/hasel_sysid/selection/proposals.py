"""Sets of effects that may be worth a fit, each next to a set that is known."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations

from hasel_sysid.selection.sets import EffectSet, FittedSet, Prospect, together

Known = Mapping[EffectSet, FittedSet]
Prospects = Mapping[EffectSet, Mapping[str, Prospect]]
"""Of every set that was looked beyond, what one more effect could do."""


@dataclass(frozen=True)
class Proposal:
    """A known set with some effects added, and some of its own dropped."""

    of: FittedSet
    added: tuple[Prospect, ...]
    dropped: frozenset[str] = frozenset()

    @cached_property
    def effects(self) -> EffectSet:
        """Of the set that is proposed."""
        return (self.of.effects - self.dropped) | {p.effect for p in self.added}

    @cached_property
    def whole(self) -> Prospect:
        """All of its changes at once, to first order."""
        alone = len(self.added) == 1 and not self.dropped
        return self.added[0] if alone else together(self.of, self.added, self.dropped)


def additions(known: Known, prospects: Prospects, beam: Sequence[EffectSet]) -> Iterator[Proposal]:
    """Sets with one effect more than those of a beam."""
    for one in beam:
        for prospect in prospects.get(one, {}).values():
            yield Proposal(known[one], (prospect,))


def exchanges(known: Known, prospects: Prospects, beam: Sequence[EffectSet]) -> Iterator[Proposal]:
    """Sets with one effect in the place of another."""
    for one in beam:
        for prospect in prospects.get(one, {}).values():
            for gone in one:
                yield Proposal(known[one], (prospect,), frozenset({gone}))


def pairs(of: FittedSet, hopeful: Sequence[Prospect]) -> Iterator[Proposal]:
    """Two effects at once."""
    for pair in combinations(hopeful, 2):
        yield Proposal(of, pair)


def smaller(known: Known, best: EffectSet) -> Iterator[Proposal]:
    """A set without one of its effects, as long as one is left."""
    for gone in best if len(best) > 1 else ():
        yield Proposal(known[best], (), frozenset({gone}))
