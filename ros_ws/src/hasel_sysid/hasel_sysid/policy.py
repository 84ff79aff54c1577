"""The numbers that a choice and a verdict rest on, with their reasons, and what a search may spend.

What defines a word or a method (a limit of detection, most of the squares, a fit's tolerance) stands where it is used.
"""

from dataclasses import dataclass, field, replace


@dataclass(frozen=True)
class Effort:
    """What a search may spend; more of it finds the same answer, or a better one, later.

    width: sets that are extended in a round; one is greedy, and of two effects that hide each other the second of the
        beam holds one.
    trials: effects that go on from a first look to further steps on a draft of the model.
    fits: sets that are fitted in full in a round; what cannot be told from the best is fitted too, up to twice as many.
    evaluations: of a full fit of the search.
    hope: share of what something should give below which its promise to first order is not followed; promises are
        that good.
    """

    width: int = 2
    trials: int = 8
    fits: int = 3
    evaluations: int = 25
    hope: float = 0.5


@dataclass(frozen=True)
class Policy:
    """level: chance of noise alone looking like this below which something is missing, and share of false ones among
        the regimes that are said not to be described; a researcher who looks at a hundred complete models will be told
        once that one is not.
    discrepancy: rms, as a share of the largest swing, of what no model has: the 0.0015 of 0.3 to which the mesh is
        converged. It enters the noise as its slowest part, so that slow deviations must be larger than fast ones.
    noise_known: share to which white noise of nine runs is known: a mean error larger by less is noise.
    near_noise: times the noise's mean error that is near it: correlated noise of nine runs is known to 8 %, and this is
        three times that.
    misfit: times the allowed rms error from which a regime is not described: laws are judged, not decimals.
    most_effects: more at a time could imitate anything.
    prior_runs: what is known of every parameter before a run is foretold, in runs: little, and not nothing, since an
        amplitude that one run alone shows could not be foretold at all.
    standard_errors: by which a larger set must be worth more than a smaller one (Breiman et al. 1984).
    matters: share below which a difference is a trifle: of the squared error that a larger set must take away (what
        another mesh leaves is less), of the error that an explanation may leave, of a law's value by which it may
        differ from its mean at either end of a range (no rig is exact).
    part: share of the error above the noise that effects must remove to be part of an explanation.
    accused: share of the squares above the noise that one effect must remove to be what is missing.
    doubt: standard errors of a log-likelihood ratio (Vuong 1989) within which two sets are not told apart, and of a
        value within which it may lie at the end of its range though it seems to lie beyond: 95 %. Twice as many, and
        what is seen is certain, however many were looked at.
    odds: to one; sets between which they are smaller are not told apart, however alike they are.
    effort: what the search may spend.
    """

    level: float = 0.01
    discrepancy: float = 0.005
    noise_known: float = 0.05
    near_noise: float = 1.25
    misfit: float = 1.5
    most_effects: int = 3
    prior_runs: float = 0.1
    standard_errors: float = 1.0
    matters: float = 0.1
    part: float = 0.6
    accused: float = 0.4
    doubt: float = 2.0
    odds: float = 20.0
    effort: Effort = field(default_factory=Effort)

    def wider(self) -> "Policy":
        """The same with a search twice as wide, for a model out of step: there, first order tells little of where a
        fit will end, and the frames are few.
        """
        now = self.effort
        return replace(
            self, effort=replace(now, width=2 * now.width, trials=2 * now.trials, fits=2 * now.fits)
        )


POLICY = Policy()
"""What every command uses."""
