# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The numbers that a choice and a verdict rest on, each with its reason.

What defines a word or a method (a limit of detection, the tolerance of a fit) stands where it is used.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Policy:
    """level: chance of noise alone looking like this below which something is missing, and share of false ones among
        the regimes with a lack of fit; a researcher who looks at a hundred complete models is told once that one is
        not.
    discrepancy: rms, as a share of the largest swing, of what no model has (Kennedy and O'Hagan 2001): the 0.0015 of
        0.3 to which the default mesh has converged. It is slow: of the covariance it is the part with most memory.
    near_noise: times the mean error that a right model may leave which still counts as that: correlated noise of nine
        runs is known to 8 %, and this is three times that.
    lack_of_fit: times the allowed rms error from which a regime is not described: laws are judged, not decimals.
    most_effects: more at a time could imitate anything.
    prior_runs: what is known of every parameter before a run is predicted, in runs: little, and not nothing, since an
        amplitude that one run alone shows could not be predicted at all.
    fewest_runs: fewer do not tell how much runs scatter.
    standard_errors: of the difference in elpd by which a larger model must be better (Breiman et al. 1984).
    confidence: standard errors of a log-likelihood ratio (Vuong 1989) within which two models of one size are not told
        apart, and of a value within which it may lie at the end of its range though it seems to lie beyond: 95 %.
    odds: to one, below which two models are not told apart in any case.
    matters: share of a value by which a law may differ from its mean at either end of a range (no rig is exact), and
        of the error above the noise that an explanation may leave.
    part: share of the error above the noise that effects must remove to be part of an explanation.
    fits: models that are fitted in full in a round of the search, side by side.
    """

    level: float = 0.01
    discrepancy: float = 0.005
    near_noise: float = 1.25
    lack_of_fit: float = 1.5
    most_effects: int = 3
    prior_runs: float = 0.1
    fewest_runs: int = 4
    standard_errors: float = 1.0
    confidence: float = 2.0
    odds: float = 20.0
    matters: float = 0.1
    part: float = 0.6
    fits: int = 3

    @property
    def reach(self) -> float:
        """By how much two models may differ in log-likelihood and perhaps not be told apart.

        At d standard errors the error itself is at most 2 d, and the log-likelihood ratio 2 d^2.
        """
        return 2 * self.confidence**2


POLICY = Policy()
"""What every command uses."""
