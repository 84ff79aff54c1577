"""What proposals promise to first order, and which of them are worth a fit."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

from hasel_sysid.selection.knowledge import Knowledge
from hasel_sysid.selection.proposals import Proposal
from hasel_sysid.selection.searched import likeness, plausible
from hasel_sysid.selection.sets import EffectSet


@dataclass
class Promises(Knowledge):
    """tried: every set that was fitted or begun."""

    tried: set[EffectSet] = field(default_factory=set)

    def __post_init__(self) -> None:
        super().__post_init__()
        self.tried |= set(self.known)

    @property
    def reach(self) -> float:
        """By how much two sets may differ in the logarithm of their likelihood and perhaps not be told apart."""
        # at d standard errors the error itself is at most 2 d, and the ratio 2 d^2: half its square is what it costs
        return 2 * self.policy.doubt**2

    def likeliest(self) -> EffectSet:
        """The known set whose values are in range that is worth most."""
        return max(plausible(self.known), key=self.value)

    def better(self, proposals: Iterable[Proposal]) -> list[Proposal]:
        """Those that promise more than the best known set, most promising first; what an effect is added to may be
        likelier than that one, and out of range: what takes nothing away from it does not mend it.
        """
        best = self.likeliest()
        ranked = self.ranked(proposals, self.value(best), self.threshold)
        more = [p for p in ranked if len(p.effects) <= len(best) or self.matters(p, best)]
        return [p for p in more if p.dropped or self.matters(p, p.of.effects)]

    def promises_less(self, proposal: Proposal, answers: int) -> bool:
        """Whether it promises less than what was reached, with as many possible answers as a beam is wide."""
        if answers < self.policy.effort.width:
            return False
        reached = self.value(self.likeliest()) - self.reach
        return self.promised(proposal) - self.threshold * len(proposal.effects) < reached

    def matters(self, proposal: Proposal, best: EffectSet) -> bool:
        """Whether it promises to take away what a larger set must."""
        left = [
            self.likelihood.squares_beyond_slack(residual, self.policy.doubt)
            for residual in (proposal.whole.least_residual, self.known[best].residual)
        ]
        return left[0] < (1 - self.policy.matters) * left[1]

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

    def broken(self, proposal: Proposal) -> bool:
        """Whether a fit took away far less of the squares than it promised to take away: it ended elsewhere."""
        before, whole = proposal.of.squares, proposal.whole
        promised = before - float(whole.least_residual @ whole.least_residual)
        kept = before - self.known[proposal.effects].squares if proposal.effects in self.known else 0.0
        return promised > self.policy.matters * before and kept < self.policy.effort.hope * promised

    def likeness(self, one: str, other: str) -> float:
        """Of two effects, beside the set that leaves least of those that both were tried beside."""
        seen = [effects for effects, found in self.prospects.items() if one in found and other in found]
        if not seen:
            return 0.0
        beside = min(seen, key=lambda effects: self.known[effects].squares)
        return likeness(self.likelihood, self.prospects[beside], one, other)

    def may_stand_in(self, proposal: Proposal, gone: str, chosen: EffectSet) -> bool:
        """Whether it promises a good part of what a chosen effect gives beside the rest, fitted anew without it."""
        rest = chosen - {gone}
        if rest not in self.known:
            return True
        without = self.whitened[rest].logarithm
        given = self.whitened[chosen].logarithm - without
        return self.promised(proposal) - without > self.policy.effort.hope * given
