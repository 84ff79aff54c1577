"""What a search asks of the sets that it knows: are they laws, do they describe their runs, would they be named?"""

from collections.abc import Sequence

from hasel_sysid.data_gate import Finding
from hasel_sysid.diagnosis.explained import Status, status_with
from hasel_sysid.estimation import FitResult
from hasel_sysid.estimation.refinement import refined
from hasel_sysid.improvement.constant_fits import ConstantFits
from hasel_sysid.improvement.lawful import against_law, effects_of
from hasel_sysid.improvement.wrong_constant import WrongConstant, wrong_constant
from hasel_sysid.policy import Policy
from hasel_sysid.selection.searched import Searched
from hasel_sysid.selection.sets import NOTHING, EffectSet, FittedSet
from hasel_sysid.selection.simulated_sets import SimulatedSets
from hasel_sysid.selection.verdicts import describes, noise_allowed, share_left_by


class Judges:
    """Of an improvement; opposed: runs that move against the model, which comes before any effect."""

    def __init__(self, sets: SimulatedSets, policy: Policy, opposed: Sequence[Finding]) -> None:
        self._sets, self._policy, self._opposed = sets, policy, opposed
        self._refined: dict[FittedSet, FitResult] = {}
        self._constants: dict[EffectSet, WrongConstant | None] = {}
        self._constant_fits = ConstantFits(sets.problem, sets.fitted.evaluation, policy, sets.given)

    def refined(self, known: FittedSet) -> FitResult:
        """The fit of a set with what finer numerics would change."""
        if known not in self._refined:
            self._refined[known] = refined(self._sets.problem, known.fit)
        return self._refined[known]

    def lawful(self, found: Searched, effects: EffectSet) -> bool:
        """Whether what a known set adds is a law."""
        return not self.lawless(found, effects)

    def lawless(self, found: Searched, effects: EffectSet) -> EffectSet:
        """The effects of a known set that are no laws."""
        known, noise, names = found.known[effects], noise_allowed(self._sets, found), sorted(effects)
        # what finer numerics change makes errors wider: what speaks for a law without it does so with it
        if not against_law(known.fit, noise, names):
            return NOTHING
        return frozenset(effects_of(against_law(self.refined(known), noise, names)))

    def described(self, found: Searched, effects: EffectSet) -> bool:
        """Whether a known set describes its runs everywhere."""
        return describes(self._sets, found, found.known[effects].fit)

    def named(self, found: Searched, effects: EffectSet) -> bool:
        """Whether its effects would be said to be missing, were this set chosen: they explain enough, and no number of
        the model file does as much.
        """
        if self._opposed or not effects:
            return False
        left = share_left_by(found, effects, noise_allowed(self._sets, found))
        status = status_with(left, self.described(found, effects), nothing_else=True)
        return status is not Status.UNEXPLAINED and self.constant(found, effects) is None

    def constant(self, found: Searched, chosen: EffectSet) -> WrongConstant | None:
        """The number of the model file that comes before a chosen set."""
        if self._opposed:
            return None
        if chosen not in self._constants:
            self._constants[chosen] = wrong_constant(
                self._sets, found, chosen, self._policy, self._constant_fits
            )
        return self._constants[chosen]
