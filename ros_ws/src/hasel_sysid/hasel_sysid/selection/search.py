"""The search over sets of effects: add, exchange, drop; what promises most is fitted in full."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

from hasel_sysid.policy import Policy
from hasel_sysid.selection.choice import all_alike, choose, smallest
from hasel_sysid.selection.full_fits import Progress
from hasel_sysid.selection.proposals import Proposal, additions, exchanges, pairs, smaller
from hasel_sysid.selection.searched import Searched, lasting, plausible, worth_most
from hasel_sysid.selection.sets import NOTHING, EffectSet, FittedSet, Sets, name_of
from hasel_sysid.selection.stand_ins import StandIns


class Judges(Protocol):
    """What may be asked of a known set beyond how likely it is."""

    def lawful(self, found: Searched, effects: EffectSet) -> bool:
        """Whether what it adds is a law."""

    def described(self, found: Searched, effects: EffectSet) -> bool:
        """Whether it describes its runs everywhere."""

    def named(self, found: Searched, effects: EffectSet) -> bool:
        """Whether its effects would be said to be missing: what is not named needs nothing that stands in its place."""


def search(
    sets: Sets,
    policy: Policy,
    progress: Progress | None = None,
    begun: tuple[FittedSet, ...] = (),
    judges: Judges | None = None,
    stand_ins: bool = True,
) -> Searched:
    """Extend the best sets as long as anything is missing from the best one and something promises to supply it.

    begun: further sets that are fitted already; judges: of sets, beyond their likelihoods; stand_ins: also fit what
    looks like a chosen effect in its place.
    """
    known = {f.effects: f for f in (sets.baseline(), *begun)}
    state = _Search(sets, policy, known, progress=progress, judges=judges)
    state.look_beyond({NOTHING: None})
    state.fit(state.singles(), 1, even_late=True)
    while True:
        more = state.anything_missing() and state.extended()
        found = state.judged()
        if not more and not state.looked_closer(found.best):
            break
    found = state.shrunk(found)
    if state.would_be_named(smallest(found, policy)):
        state.fit(state.rivals(found, smallest(found, policy)), policy.effort.fits)
        state.look_for_a_law()
    state.deepen(state.chosen())
    if stand_ins and state.would_be_named(state.chosen()):
        state.exchange(state.chosen())
    return state.judged()


@dataclass
class _Search(StandIns):
    """closely: the sets that were looked beyond with every effect."""

    closely: set[EffectSet] = field(default_factory=lambda: {NOTHING})
    judges: Judges | None = None

    def would_be_named(self, effects: EffectSet) -> bool:
        """Whether its effects would be said to be missing."""
        return self.judges is None or self.judges.named(self.judged(), effects)

    def anything_missing(self) -> bool:
        """From the best set, by more than noise."""
        return self.judged().last.chance < self.policy.level

    def extended(self) -> bool:
        """Whether anything promised more than the best set and was fitted."""
        if self.fit(self.better(self.additions([NOTHING])), self.policy.effort.fits, enough=self.needless):
            return True
        self.fit(self.singles(), self.policy.effort.fits - sum(map(bool, plausible(self.known))))
        beam = self.beam()
        self.look_beyond_where_anything_is_missing(beam)
        around = self.better(self.around(beam))
        return self.fit(around, self.policy.effort.fits, enough=self.needless) > 0

    def needless(self, proposal: Proposal, answers: int) -> bool:
        """Whether it promises less than what was reached, or is larger than a set that wants nothing."""
        if self.promises_less(proposal, answers):
            return True
        self.use_noise()  # which the last fit may tell better
        best = self.likeliest()
        # the test of what is missing draws noise and judges every set: it is made only where little is left
        if len(proposal.effects) <= len(best) or self.leaves_what_matters(best):
            return False
        return not self.anything_missing() and not self.fails(best)

    def beam(self) -> list[EffectSet]:
        """The best sets, and the likeliest one where its values are out of range: it is no answer itself, but an
        effect beside it or in its place may be.
        """
        best = lasting(plausible(self.known), self.value)[: self.policy.effort.width]
        likeliest = max(self.known, key=self.value)
        return best if likeliest in best else [likeliest, *best]

    def looked_closer(self, best: EffectSet) -> bool:
        """Whether a set that leaves more than noise was looked beyond only now, and with every effect.

        Beside the baseline effects look otherwise: what holds a body up also puts it out of step there.
        """
        known = best in self.closely or len(best) >= self.policy.most_effects
        if known or self.sets.out_of_time() or not (self.leaves_what_matters(best) or self.fails(best)):
            return False
        self.closely.add(best)
        self.look_beyond({best: None})
        return True

    def fails(self, effects: EffectSet) -> bool:
        """Whether a set does not describe its runs somewhere: where nothing shows the noise alone, what the best set
        leaves is all that is known of it, and only its shares tell that some of it is no noise.
        """
        return self.judges is not None and not self.judges.described(self.judged(), effects)

    def look_beyond(self, wanted: Mapping[EffectSet, Collection[str] | None]) -> None:
        """Learn what one more effect of those that are wanted (None: any) could do to each of these sets."""
        self.say(f"looking beyond {', '.join(map(name_of, wanted))}", 0.1 * min(len(self.known), 5))
        looks = [(self.known[effects], names) for effects, names in wanted.items()]
        seen = self.sets.prospects_of_each(looks, self.likelihood.promised, self.policy.effort.trials)
        self.prospects.update(zip(wanted, seen, strict=True))

    def look_beyond_where_anything_is_missing(self, beam: Sequence[EffectSet]) -> None:
        """The same of these sets, as far as none was looked beyond yet."""
        new = [s for s in beam if s not in self.prospects and len(s) < self.policy.most_effects]
        if new and not self.sets.out_of_time():
            self.look_beyond({effects: self.promising_beside(effects) for effects in new})

    def promising_beside(self, effects: EffectSet) -> list[str]:
        """The effects whose score is more than noise alone makes of it, and those that cost nothing.

        Beside the baseline, where that score is from, two wrong constants may look alike that together are the answer.
        """
        test = self.tested(effects)
        promising = sorted(test.gains, key=lambda effect: -test.gains[effect])[
            : 2 * self.policy.effort.trials
        ]
        wanted = [e for e in promising if test.gains[e] > test.threshold and self.could_matter(e, effects)]
        return list(dict.fromkeys([*wanted, *self.sets.at_null]))

    def singles(self) -> list[Proposal]:
        """Sets of one effect, most promising first."""
        return self.ranked(self.additions([NOTHING]))

    def additions(self, beam: Sequence[EffectSet]) -> Iterator[Proposal]:
        """Sets with one effect more than those of a beam."""
        return additions(self.known, self.prospects, beam)

    def around(self, beam: Sequence[EffectSet]) -> Iterator[Proposal]:
        """One effect more than a beam, one in another's place, or two at once, which may hide each other."""
        yield from self.additions(beam)
        yield from exchanges(self.known, self.prospects, beam)
        base = self.prospects[NOTHING]
        hopeful = sorted(base.values(), key=self.likelihood.promised, reverse=True)[
            : self.policy.effort.trials
        ]
        yield from pairs(self.known[NOTHING], hopeful)

    def shrunk(self, found: Searched) -> Searched:
        """With every part of the smallest set fitted that lacks one effect, until no smaller one does."""
        while self.fit(self.parts(smallest(found, self.policy)), self.policy.most_effects):
            found = self.judged()
        return found

    def parts(self, chosen: EffectSet) -> list[Proposal]:
        """A set without each of its effects in turn, as far as that was not fitted yet.

        Fitted from the values of the others, or from a known set with one effect less where those are farther off.
        """
        return [self._nearest(without) for without in self.possible(smaller(self.known, chosen))]

    def _nearest(self, without: Proposal) -> Proposal:
        part = self.best_part(without.effects)
        if part is None or self.sets.out_of_time():
            return without
        (gone,) = without.dropped
        left = self.sets.without(without.of, gone)
        if left is not None and left.squares < self.known[part].squares:
            return Proposal(left, ())
        return self.beside(part, without.effects) or without

    def rivals(self, found: Searched, chosen: EffectSet) -> list[Proposal]:
        """Sets of the chosen one's size that come so near to it that they may not be told apart."""
        reach = found.whitened[chosen].logarithm - self.reach
        return self.ranked(self.additions(self.known_parts(chosen)), reach)

    def look_for_a_law(self) -> None:
        """Fit what promises most beside the best law, until something that may stand in the chosen set's place is one.

        That promise may be small: what stood in for an effect by no law has drawn every other value to itself.
        """
        chosen = smallest(self.judged(), self.policy)
        if not chosen or self.judges is None or self.may_be_a_law(chosen):
            return
        law = self.best_law(len(chosen) - 1)
        if law is None or self.sets.out_of_time():
            return
        if law not in self.closely:
            self.closely.add(law)
            self.look_beyond({law: None})
        beside = [p for p in self.ranked(self.additions([law])) if self.matters(p, law)]
        self.fit(beside, self.policy.effort.fits, enough=lambda *_: self.may_be_a_law(chosen))

    def may_be_a_law(self, chosen: EffectSet) -> bool:
        """Whether a set is a law, or one that may stand in its place."""
        found = self.judged()
        return any(self.is_law(found, one) for one in all_alike(found, chosen, self.policy))

    def best_law(self, size: int) -> EffectSet | None:
        """Of the known sets of a size that are laws, the one that is worth most; no effect at all is one."""
        found = self.judged()
        every = [one for one in worth_most(found) if len(one) == size]
        return next((one for one in every if not one or self.is_law(found, one)), None)

    def chosen(self) -> EffectSet:
        """The set that would be taken now."""
        found = self.judged()
        return choose(found, self.policy, partial(self.is_law, found)).chosen

    def is_law(self, found: Searched, effects: EffectSet) -> bool:
        """Whether what a known set adds is a law; where nobody judges, everything is."""
        return self.judges is None or self.judges.lawful(found, effects)

    def deepen(self, chosen: EffectSet) -> None:
        """Look for a deeper valley of the set to be taken."""
        if chosen and not self.sets.out_of_time():
            self.say(f"looking for {name_of(chosen)} elsewhere", 0.9)
            self.keep(self.sets.deepest(self.known[chosen]))
