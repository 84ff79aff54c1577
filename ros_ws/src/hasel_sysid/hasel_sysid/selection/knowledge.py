"""What is known of sets of effects while a search goes on, and how they are judged by it."""

import math
from dataclasses import dataclass, field

import numpy as np

from hasel_sysid.policy import Policy
from hasel_sysid.projection import drops, orthonormal
from hasel_sysid.selection.likelihood import Likelihood
from hasel_sysid.selection.missing import Missing, missing
from hasel_sysid.selection.searched import Searched, plausible
from hasel_sysid.selection.sets import NOTHING, EffectSet, FittedSet, Prospect, Sets
from hasel_sysid.selection.worth import worth


@dataclass
class Knowledge:
    """known: every set that was fitted; prospects: of every set that was looked beyond, what one more effect could do;
    threshold: what noise alone may gain by an effect.
    """

    sets: Sets
    policy: Policy
    known: dict[EffectSet, FittedSet]
    prospects: dict[EffectSet, dict[str, Prospect]] = field(default_factory=dict)
    threshold: float = 0.0

    def __post_init__(self) -> None:
        self.use_noise()

    def use_noise(self) -> None:
        """Judge by what the best fits so far tell of the noise, and compare by what the best one lacks as well.

        Noise alone says whether anything is missing. As long as something is, sets differ by far more than noise, and
        most where it is quietest: there a likelihood of noise would compare them by a few fast frames only. What the
        best one lacks counts as an error of its own, so that then it is the squares that are compared; the more that
        is beyond the declared discrepancy, the less is known of it, not even that it is slow.
        """
        noise = self.sets.noise(list(self.known.values()))
        discrepancy = self.policy.discrepancy * self.sets.swing
        best = min((self.known[s] for s in plausible(self.known)), key=lambda f: f.squares)
        left = best.squares / max(len(best.residual) - best.jacobian.shape[1], 1)
        lacking = math.sqrt(max(0.0, left - noise.standard_deviation**2))
        self.beyond_noise = lacking**2 / left if left > 0 else 0.0
        declared = discrepancy * min(1.0, discrepancy / lacking) if lacking else discrepancy
        misfit = max(0.0, lacking**2 - declared**2)
        self.noise_alone = Likelihood(noise, self.sets.runs, discrepancy, self.sets.slack)
        self.likelihood = Likelihood(noise, self.sets.runs, declared, self.sets.slack, misfit)
        self.whitened = {effects: self.likelihood.whitened(f) for effects, f in self.known.items()}

    def judged(self) -> Searched:
        """All known sets by the noise as it is known now."""
        self.use_noise()
        worths = {s: worth(w, self.sets.measured, self.policy.prior_runs) for s, w in self.whitened.items()}
        best = max(plausible(self.known), key=lambda s: worths[s].total)
        first = self.tested(NOTHING)
        last = self.tested(best) if best else first
        self.threshold = last.threshold
        base = dict(self.prospects[NOTHING])
        return Searched(
            dict(self.known),
            self.likelihood,
            dict(self.whitened),
            worths,
            first,
            last,
            base,
            self.policy.level,
            self.tested,
            self.beyond_noise,
        )

    def tested(self, effects: EffectSet) -> Missing:
        """Whether anything is missing from a known set."""
        fitted = self.noise_alone.whitened(self.known[effects])
        return missing(fitted, self.looks(effects), self.noise_alone, self.policy.level)

    def looks(self, beside: EffectSet) -> dict:
        """What the effects that are not in a set look like: there, or at least beside the baseline."""
        seen = {**self.prospects[NOTHING], **self.prospects.get(beside, {})}
        return {
            effect: prospect.looks
            for effect, prospect in seen.items()
            if effect not in beside and self.sets.compatible(beside | {effect})
        }

    def could_matter(self, effect: str, beside: EffectSet) -> bool:
        """Whether it looks like a good part of what a larger set must take away."""
        fitted = self.known[beside]
        most = drops(self.looks(beside)[effect], orthonormal(fitted.jacobian), fitted.residual)
        return float(most) > self.policy.effort.hope * self.policy.matters * fitted.squares

    def value(self, effects: EffectSet) -> float:
        """Of a known set: likelier by what noise alone may gain, for every effect more."""
        return self.whitened[effects].logarithm - self.threshold * len(effects)

    def leaves_what_matters(self, effects: EffectSet) -> bool:
        """Whether more of the squares than is ever worth an effect is beyond what noise explains."""
        fitted = self.noise_alone.whitened(self.known[effects])
        squares = float(fitted.residual @ fitted.residual)
        free = len(fitted.residual) - fitted.basis.shape[1] - len(np.unique(fitted.runs))
        return squares - free > self.policy.matters * squares

    def keep(self, fitted: FittedSet | None) -> None:
        """Of two fits of a set the better one."""
        if fitted is None:
            return
        known = self.known.get(fitted.effects)
        if known is None or fitted.squares < known.squares:
            self.known[fitted.effects] = fitted
            self.whitened[fitted.effects] = self.likelihood.whitened(fitted)
