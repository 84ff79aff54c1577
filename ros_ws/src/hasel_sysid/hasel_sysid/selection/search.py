"""The search over sets of effects: add, exchange, drop; what promises most is fitted in full."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial

from hasel_sysid.selection.knowledge import Knowledge
from hasel_sysid.selection.policy import Policy
from hasel_sysid.selection.proposals import Proposal, additions, exchanges, pairs, smaller
from hasel_sysid.selection.searched import Searched, likeness, plausible
from hasel_sysid.selection.sets import NOTHING, EffectSet, FittedSet, Sets, name_of

Progress = Callable[[str, float], None]


def search(
    sets: Sets,
    policy: Policy,
    progress: Progress | None = None,
    begun: tuple[FittedSet, ...] = (),
    stand_ins: bool = True,
) -> Searched:
    """Extend the best sets as long as anything is missing from the best one and something promises to supply it.

    begun: further sets that are fitted already; stand_ins: also fit what looks like a chosen effect in its place.
    """
    known = {f.effects: f for f in (sets.baseline(), *begun)}
    state = _Search(sets, policy, known, progress=progress)
    state.look_beyond(NOTHING, None)
    state.fit(state.singles(), 1, even_late=True)
    while True:
        found = state.judged()
        done = found.last.chance >= policy.level or not state.extended()
        if done and not state.looked_closer(found.best):
            break
    state.fit(state.possible(smaller(found.known, found.best)), policy.most_effects)
    state.fit(state.rivals(found), policy.fits)
    for one in state.near_the_best(found) if stand_ins else ():
        state.exchange(one)
    return state.judged()


@dataclass
class _Search(Knowledge):
    """tried: every set that was fitted or begun; closely: those that were looked beyond with every effect."""

    progress: Progress | None = None
    tried: set[EffectSet] = field(default_factory=set)
    closely: set[EffectSet] = field(default_factory=lambda: {NOTHING})

    def __post_init__(self) -> None:
        super().__post_init__()
        self.tried |= set(self.known)

    def say(self, text: str, done: float) -> None:
        if self.progress:
            self.progress(text, done)

    def extended(self) -> bool:
        """Whether anything promised more than the best set and was fitted."""
        if self.fit(self.better(self.additions([NOTHING])), self.policy.fits):
            return True
        self.fit(self.singles(), self.policy.fits - sum(map(bool, plausible(self.known))))
        beam = sorted(plausible(self.known), key=self.value)[-self.policy.width :]
        for one in beam:
            self.look_beyond_if_anything_is_missing(one)
        return self.fit(self.better(self.around(beam)), self.policy.fits) > 0

    def looked_closer(self, best: EffectSet) -> bool:
        """Whether a set that leaves more than noise was looked beyond only now, and with every effect.

        Beside the baseline effects look otherwise: what holds a body up also puts it out of step there.
        """
        known = best in self.closely or len(best) >= self.policy.most_effects
        if known or self.sets.out_of_time() or not self.leaves_what_matters(best):
            return False
        self.closely.add(best)
        self.look_beyond(best, None)
        return True

    def look_beyond(self, effects: EffectSet, wanted: list[str] | None) -> None:
        """Learn what one more effect could do to a set."""
        self.say(f"looking beyond {name_of(effects)}", 0.1 * min(len(self.known), 5))
        self.prospects[effects] = self.sets.prospects(
            self.known[effects], wanted, self.likelihood.promised, self.policy.trials
        )

    def look_beyond_if_anything_is_missing(self, effects: EffectSet) -> None:
        """The same for the effects whose score is more than noise alone makes of it."""
        if effects in self.prospects or len(effects) >= self.policy.most_effects or self.sets.out_of_time():
            return
        test = self.tested(effects)
        promising = sorted(test.gains, key=lambda effect: -test.gains[effect])[: 2 * self.policy.trials]
        self.look_beyond(effects, [effect for effect in promising if test.gains[effect] > test.threshold])

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
        hopeful = sorted(base.values(), key=self.likelihood.promised, reverse=True)[: self.policy.trials]
        yield from pairs(self.known[NOTHING], hopeful)

    def near_the_best(self, found: Searched) -> list[EffectSet]:
        """The best set, and the one that is worth most of those with one effect less."""
        less = [one for one in plausible(found.known) if len(one) == len(found.best) - 1]
        return [found.best, *sorted(less, key=lambda one: -found.worths[one].total)[:1]]

    def rivals(self, found: Searched) -> list[Proposal]:
        """Sets of the best one's size that come so near to it that they may not be told apart."""
        reach = found.whitened[found.best].logarithm - self._reach
        parts = [part for gone in found.best if (part := found.best - {gone}) in self.known]
        return self.ranked(self.additions(parts), reach)

    def exchange(self, best: EffectSet) -> None:
        """Fit a set with what looks most like one of its effects, and does not do far less alone, in its place."""
        alone = {next(iter(s)): w.logarithm for s, w in self.whitened.items() if len(s) == 1}
        for gone in sorted(best) if len(best) > 1 else ():
            like_it = partial(likeness, self.likelihood, self.prospects[NOTHING], gone)
            least = alone.get(gone, -math.inf) - self._reach
            others = [e for e in self.prospects[NOTHING] if e not in best and alone.get(e, math.inf) >= least]
            for effect in sorted(others, key=like_it, reverse=True)[: self.policy.width]:
                effects = best - {gone} | {effect}
                if effects in self.tried or not self.sets.compatible(effects) or self.sets.out_of_time():
                    continue
                self.tried.add(effects)
                self.say(f"fitting {name_of(effects)}", 0.9)
                self.keep(self._in_place_of(gone, best, effect))

    def _in_place_of(self, gone: str, best: EffectSet, effect: str) -> FittedSet | None:
        """From where the fit of the effect alone has led, or its trial beside the baseline."""
        of, alone = self.known[best], frozenset({effect})
        if alone in self.known:
            return self.sets.exchanged(of, gone, self.known[alone])
        return self.sets.fit(best - {gone} | alone, of, (self.prospects[NOTHING][effect],))

    @property
    def _reach(self) -> float:
        """By how much two sets may differ in the logarithm of their likelihood and perhaps not be told apart."""
        # at d standard errors the error itself is at most 2 d, and the ratio 2 d^2: half its square is what it costs
        return 2 * self.policy.doubt**2

    def better(self, proposals: Iterable[Proposal]) -> list[Proposal]:
        """Those that promise more than the best known set, most promising first."""
        best = max(map(self.value, plausible(self.known)))
        return self.ranked(proposals, best, self.threshold)

    def ranked(
        self, proposals: Iterable[Proposal], least: float = -math.inf, of_each: float = 0.0
    ) -> list[Proposal]:
        """Those whose promise, less so much for each effect, is more than the least; most promising first."""
        valued = [(self.promised(p) - of_each * len(p.effects), p) for p in self.possible(proposals)]
        return [p for value, p in sorted(valued, key=lambda pair: -pair[0]) if value > least]

    def possible(self, proposals: Iterable[Proposal]) -> Iterator[Proposal]:
        """Those that were not tried yet, are not too large, and whose effects go together."""
        for proposal in proposals:
            effects = proposal.effects
            small = effects not in self.tried and len(effects) <= self.policy.most_effects
            if small and self.sets.compatible(effects):
                yield proposal

    def promised(self, proposal: Proposal) -> float:
        """The logarithm of its likelihood, to first order."""
        return self.likelihood.promised(proposal.whole)

    def fit(self, proposals: Iterable[Proposal], most: int, even_late: bool = False) -> int:
        """Fit the first of these in full; how many were."""
        count = 0
        for proposal in proposals:
            if count >= most or (self.sets.out_of_time() and not even_late):
                break
            if proposal.effects in self.tried:
                continue
            self.tried.add(proposal.effects)
            self.say(f"fitting {name_of(proposal.effects)}", min(0.9, 0.1 * len(self.tried)))
            self.keep(self.sets.fit(proposal.effects, proposal.of, proposal.added))
            self.keep(self._again(proposal.effects))
            count += 1
        return count

    def _again(self, effects: EffectSet) -> FittedSet | None:
        """From its best smaller set, where it ended with larger squares than that one: then it was lost on its way."""
        below = [part for gone in effects if (part := effects - {gone}) in self.known]
        if not below:
            return None
        best = min(below, key=lambda part: self.known[part].squares)
        if effects in self.known and self.known[effects].squares <= self.known[best].squares:
            return None
        (new,) = effects - best
        prospect = {**self.prospects[NOTHING], **self.prospects.get(best, {})}.get(new)
        return None if prospect is None else self.sets.fit(effects, self.known[best], (prospect,))
