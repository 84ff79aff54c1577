"""Fits of proposals in full, once more where they were lost on their way."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from hasel_sysid.selection.promises import Promises
from hasel_sysid.selection.proposals import Proposal
from hasel_sysid.selection.searched import plausible
from hasel_sysid.selection.sets import NOTHING, FittedSet, name_of

Progress = Callable[[str, float], None]

_AS_GOOD = 1.001
"""A fit that ends with so many times the squares of a smaller set's has lost nothing: ten times its tolerance."""


@dataclass
class FullFits(Promises):
    """progress: told what is being done, and the share that is done."""

    progress: Progress | None = None

    def say(self, text: str, done: float) -> None:
        """Tell what is being done."""
        if self.progress:
            self.progress(text, done)

    def fit(self, proposals: Iterable[Proposal], most: int, even_late: bool = False) -> int:
        """Fit the first of these in full, until so many are possible answers, at most twice as many; how many were."""
        count = answers = 0
        for proposal in proposals:
            enough = answers >= most or count >= 2 * most
            if enough or (self.sets.out_of_time() and not even_late):
                break
            if proposal.effects in self.tried:
                continue
            self.tried.add(proposal.effects)
            self.say(f"fitting {name_of(proposal.effects)}", min(0.9, 0.1 * len(self.tried)))
            self.keep(self.sets.fit(proposal.effects, proposal.of, proposal.added))
            self.keep(self._again(proposal))
            self.keep(self._from_other_sizes(proposal))
            count += 1
            answers += proposal.effects in plausible(self.known)
        return count

    def _again(self, proposal: Proposal) -> FittedSet | None:
        """From its best smaller set, where it ended with larger squares than that one: then it was lost on its way.

        Not where it began there.
        """
        effects = proposal.effects
        below = [part for gone in effects if (part := effects - {gone}) in self.known]
        if not below:
            return None
        best = min(below, key=lambda part: self.known[part].squares)
        if effects in self.known and self.known[effects].squares <= _AS_GOOD * self.known[best].squares:
            return None
        (new,) = effects - best
        prospect = {**self.prospects[NOTHING], **self.prospects.get(best, {})}.get(new)
        begun = proposal.of is self.known[best] and not proposal.dropped and prospect in proposal.added
        return None if prospect is None or begun else self.sets.fit(effects, self.known[best], (prospect,))

    def _from_other_sizes(self, proposal: Proposal) -> FittedSet | None:
        """A fit of one more effect that did not keep its promise: there is more than one valley."""
        alone = len(proposal.added) == 1 and not proposal.dropped
        if not alone or self.sets.out_of_time() or not self.broken(proposal):
            return None
        other = self.sets.from_other_sizes(proposal.of, proposal.added[0])
        return None if other is None else self.sets.fit(proposal.effects, proposal.of, (other,))
