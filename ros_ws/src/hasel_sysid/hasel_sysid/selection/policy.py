"""Every number that the choice of effects rests on, with its reason."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Policy:
    """level: chance of noise alone looking like this below which something is missing; a researcher who looks at a
        hundred complete models will be told once that one is not.
    discrepancy: rms, as a share of the largest swing, of what no model has: the 0.0015 of 0.3 to which the mesh is
        converged. It enters the noise as its slowest part, so that slow deviations must be larger than fast ones.
    most_effects: more at a time could imitate anything.
    width: sets that are extended in a round; one is greedy, and of two effects that hide each other the second of the
        beam holds one.
    trials: effects that go on from a first look to further steps on a draft of the model.
    fits: sets that are fitted in full in a round; what cannot be told from the best is fitted too, up to twice as many.
    prior_runs: what is known of every parameter before a run is foretold, in runs: little, and not nothing, since an
        amplitude that one run alone shows could not be foretold at all.
    standard_errors: by which a larger set must be worth more than a smaller one (Breiman et al. 1984).
    matters: share of the squared error that a larger set must take away; what another mesh leaves is less.
    doubt: standard errors of a log-likelihood ratio (Vuong 1989) within which two sets are not told apart, 95 %.
    odds: to one; sets between which they are smaller are not told apart, however alike they are.
    hope: share of what something should give below which its promise to first order is not followed; promises are
        that good.
    """

    level: float = 0.01
    discrepancy: float = 0.005
    most_effects: int = 3
    width: int = 2
    trials: int = 8
    fits: int = 3
    prior_runs: float = 0.1
    standard_errors: float = 1.0
    matters: float = 0.1
    doubt: float = 2.0
    odds: float = 20.0
    hope: float = 0.5

    def wider(self) -> "Policy":
        """The same with a search twice as wide, for a model out of step: there, first order tells little of where a
        fit will end, and the frames are few.
        """
        return replace(self, width=2 * self.width, trials=2 * self.trials, fits=2 * self.fits)


POLICY = Policy()
"""What every command uses."""
