"""Fits of proposals in full, once more where they were lost on their way."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from hasel_sysid.selection.promises import Promises
from hasel_sysid.selection.proposals import Proposal
from hasel_sysid.selection.searched import plausible
from hasel_sysid.selection.sets import EffectSet, FittedSet, name_of

Progress = Callable[[str, float], None]

_AS_GOOD = 1.001
"""A fit that ends with so many times the squares of a smaller set's has lost nothing: ten times its tolerance."""


def never(proposal: Proposal, answers: int) -> bool:
    """Do not leave a proposal, however many answers there are."""
    return False


@dataclass
class FullFits(Promises):
    """progress: told what is being done, and the share that is done."""

    progress: Progress | None = None

    def say(self, text: str, done: float) -> None:
        """Tell what is being done."""
        if self.progress:
            self.progress(text, done)

    def fit(
        self,
        proposals: Sequence[Proposal],
        most: int,
        even_late: bool = False,
        enough: Callable[[Proposal, int], bool] = never,
        then: Sequence[Proposal] = (),
    ) -> int:
        """Fit the first of these in full, until so many are possible answers, at most twice as many; how many were.

        enough: whether a proposal is left with those behind it, after so many answers; then: what is likely to be asked
        for afterwards.
        """
        count = answers = 0
        for number, proposal in enumerate(proposals):
            if answers >= most or count >= 2 * most or (self.sets.out_of_time() and not even_late):
                break
            if proposal.effects in self.tried:
                continue
            if enough(proposal, answers):
                break
            self.tried.add(proposal.effects)
            left = min(most - answers, 2 * most - count) - 1
            likely = self.untried(proposals[number + 1 :])[:left]
            likely = [p for p in likely if not enough(p, answers + 1)]
            self.foresee([proposal, *likely, *self.untried(then)])
            self.say(f"fitting {name_of(proposal.effects)}", min(0.9, 0.1 * len(self.tried)))
            self.keep(self.sets.fit(proposal.effects, proposal.of, proposal.added))
            self.keep(self._again(proposal))
            self.keep(self._from_other_sizes(proposal))
            count += 1
            answers += proposal.effects in plausible(self.known)
        self.foresee(self.untried(then))
        return count

    def untried(self, proposals: Sequence[Proposal]) -> list[Proposal]:
        """The first of these for every set that was not fitted yet."""
        first = {p.effects: p for p in reversed(proposals) if p.effects not in self.tried}
        return [p for p in proposals if first.get(p.effects) is p]

    def foresee(self, likely: Sequence[Proposal]) -> None:
        """Tell what may be fitted next."""
        late = self.sets.out_of_time()
        self.sets.foresee([] if late else [(p.effects, p.of, p.added) for p in likely])

    def _again(self, proposal: Proposal) -> FittedSet | None:
        """From its best smaller set, where it ended with larger squares than that one: then it was lost on its way.

        Not where it began there.
        """
        effects = proposal.effects
        best = self.best_part(effects)
        if best is None or self.sets.out_of_time():
            return None
        if effects in self.known and self.known[effects].squares <= _AS_GOOD * self.known[best].squares:
            return None
        if proposal.of is self.known[best] and not proposal.dropped:
            return None
        again = self.beside(best, effects)
        return None if again is None else self.sets.fit(effects, again.of, again.added)

    def known_parts(self, effects: EffectSet) -> list[EffectSet]:
        """The known sets that lack one of these effects."""
        return [part for gone in effects if (part := effects - {gone}) in self.known]

    def best_part(self, effects: EffectSet) -> EffectSet | None:
        """Of these the one that leaves least."""
        return min(self.known_parts(effects), key=lambda part: self.known[part].squares, default=None)

    def beside(self, part: EffectSet, effects: EffectSet) -> Proposal | None:
        """The one effect more that these have than a known part of them, looked at there."""
        (new,) = effects - part
        seen = self.prospects.get(part, {})
        if new not in seen:
            rank, most = self.likelihood.promised, self.policy.effort.trials
            seen = self.sets.prospects(self.known[part], [new], rank, most)
        return Proposal(self.known[part], (seen[new],)) if new in seen else None

    def _from_other_sizes(self, proposal: Proposal) -> FittedSet | None:
        """A fit of one more effect that did not keep its promise, where another size of it promises another valley."""
        alone = len(proposal.added) == 1 and not proposal.dropped
        if not alone or self.sets.out_of_time() or not self.broken(proposal):
            return None
        other = self.sets.from_other_sizes(proposal.of, proposal.added[0])
        if other is None or not self.matters(Proposal(proposal.of, (other,)), proposal.of.effects):
            return None
        return self.sets.fit(proposal.effects, proposal.of, (other,))
