"""What may stand in the place of one of several chosen effects: looked for beside the others, and fitted."""

from dataclasses import dataclass
from functools import partial

from hasel_sysid.selection.choice import alike
from hasel_sysid.selection.full_fits import FullFits
from hasel_sysid.selection.proposals import Proposal
from hasel_sysid.selection.sets import NOTHING, EffectSet


@dataclass
class StandIns(FullFits):
    """Fits in full, and what tells which effects cannot be told apart."""

    def exchange(self, chosen: EffectSet) -> None:
        """Fit sets with what looks like one of the effects in its place, as long as they cannot be told apart.

        Of what ended otherwise than it promised, the next promise says as little.
        """
        for gone in sorted(chosen) if len(chosen) > 1 else ():
            proposals = self.stand_ins(gone, chosen)
            for number, proposal in enumerate(proposals):
                if not self.fit([proposal], 1, then=proposals[number + 1 :]):
                    break
                same = proposal.effects in self.known and alike(
                    self.judged(), chosen, proposal.effects, self.policy
                )
                if not same and self.kept(proposal):
                    break
            self.foresee([])

    def kept(self, proposal: Proposal) -> bool:
        """Whether a fit ended, for better or worse, as likely as it promised to."""
        ended = self.whitened.get(proposal.effects)
        return ended is not None and abs(ended.logarithm - self.promised(proposal)) <= self.reach

    def acts_alone(self, effect: str) -> bool:
        """Whether it was fitted alone, and not left without effect."""
        alone = self.known.get(frozenset({effect}))
        if alone is None:
            return False
        change = alone.without[effect]
        return float(change @ change) > self.policy.matters * alone.squares

    def stand_ins(self, gone: str, chosen: EffectSet) -> list[Proposal]:
        """What looks like an effect and promises to do in its place; most promising first.

        What was fitted alone is tried as large as it is there, all else left as it is, however little it looks like the
        effect: beside a model that is out of step, looks say little. The others are tried beside the rest.
        """
        self.say(f"looking for what may stand in the place of {gone}", 0.9)
        others = [e for e in self.prospects[NOTHING] if e not in chosen]
        most_alike = sorted(others, key=partial(self.likeness, gone), reverse=True)[
            : self.policy.effort.trials
        ]
        sized = [e for e in others if self.acts_alone(e)]
        wanted = [e for e in dict.fromkeys([*most_alike, *sized]) if chosen - {gone} | {e} not in self.tried]
        alone = {e: self.known[frozenset({e})] for e in wanted if e in sized}
        places = [
            (self.sets.without(self.known[chosen], gone) if alone else None, list(alone)),
            (self.known.get(chosen - {gone}), [e for e in wanted if e not in alone]),
        ]
        found: list[Proposal] = []
        for rest, effects in places:
            if rest is not None and not self.sets.out_of_time():
                seen = self.sets.prospects(
                    rest, effects, self.likelihood.promised, self.policy.effort.trials, alone
                )
                found += [Proposal(rest, (prospect,)) for prospect in seen.values()]
        return [p for p in self.ranked(found) if self.may_stand_in(p, gone, chosen)][
            : self.policy.effort.fits
        ]
