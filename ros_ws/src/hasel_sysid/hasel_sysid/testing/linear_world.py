# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Sets of candidates without a simulator, for tests: every effect adds a known series, and the noise is known."""

from collections.abc import Callable, Collection, Iterable, Mapping

import numpy as np
from hasel_sim.effects.base import EffectParameter
from hasel_sim.model import load_model
from hasel_sim.run import Run

from hasel_sysid.candidates import Candidate
from hasel_sysid.estimation.fit import FittedModel
from hasel_sysid.noise import NoiseModel
from hasel_sysid.policy import POLICY
from hasel_sysid.selection.choose import Choice, Judged, choose
from hasel_sysid.selection.cross_validation import leave_one_run_out
from hasel_sysid.selection.likelihood import FittedSet, Likelihood, Names
from hasel_sysid.selection.linearise import CandidateColumns
from hasel_sysid.testing.made_up_runs import evaluation_of_runs, made_up_effect, with_made_up

RUNS, FRAMES = 8, 80
WHITE = NoiseModel(0.03**2, 0.0, 0.5)
SLOW = NoiseModel(0.01**2, 0.03**2, 0.9)
_OWN = "material.soft.youngs_modulus_pa"


def not_excused(names: Names, change: np.ndarray) -> bool:
    """Here a model has everything."""
    return False


def run_numbers(runs: int = RUNS, frames: int = FRAMES) -> np.ndarray:
    """Number of the run of every frame, [frames]."""
    return np.repeat(np.arange(runs), frames)


def smooth_series(generator: np.random.Generator, runs: np.ndarray) -> np.ndarray:
    """A few tones in every run, with an rms of 1, [frames]."""
    series = np.empty(len(runs))
    for run in np.unique(runs):
        time = np.arange((runs == run).sum()) / 120.0
        tones = np.outer(time, 2 * np.pi * generator.uniform(0.5, 8.0, 5)) + generator.uniform(0, 6.3, 5)
        own = np.sin(tones) @ generator.standard_normal(5)
        series[runs == run] = (own - own.mean()) / own.std()
    return series


def unlike_series(
    seed: int, names: Iterable[str] = "abcdefghij", runs: np.ndarray | None = None
) -> dict[str, np.ndarray]:
    """A series [frames] for every name, unlike each other."""
    generator = np.random.default_rng(seed)
    return {name: smooth_series(generator, run_numbers() if runs is None else runs) for name in names}


class LinearWorld:
    """measured = what one fitted constant does + sizes times the series of effects + a stranger + noise."""

    def __init__(
        self,
        series: Mapping[str, np.ndarray],
        sizes: Mapping[str, float],
        noise: NoiseModel = WHITE,
        seed: int = 0,
        stranger: np.ndarray | float = 0.0,
        runs: np.ndarray | None = None,
        largest: float = 10.0,
    ) -> None:
        """series [frames] of every effect; sizes: of those that are there; largest: plausible size of any."""
        self.runs = run_numbers() if runs is None else runs
        self._model = load_model("beam").with_freed(_OWN)
        generator = np.random.default_rng([seed, 17])
        self._base = self._centred(smooth_series(generator, self.runs))
        self.series = {name: self._centred(one) for name, one in series.items()}
        truth = stranger + self._base + sum(size * series[name] for name, size in sizes.items())
        self.measured = self._centred(truth + noise.sample(self.runs, 1, generator)[:, 0])
        size = EffectParameter("size", "x", "1", 0.0, -largest, largest, 1.0)
        self.candidates = {n: Candidate(n, (size,), made_up_effect(n, size)) for n in series}
        self.likelihood = Likelihood(noise, self.runs)

    def fitted(self, names: Iterable[str], at_bound: tuple[str, ...] = ()) -> FittedSet:
        """The least-squares fit of a set, within no bounds. at_bound: what is said to have ended on one."""
        chosen = sorted(names)
        columns = np.column_stack([self._base, *(self.series[name] for name in chosen)])
        amounts = np.linalg.lstsq(columns, self.measured, rcond=None)[0]
        model = with_made_up(
            self._model, *(effect for name in chosen if (effect := self.candidates[name].effect) is not None)
        )
        paths = [f"{name}.size" for name in chosen]
        unit = model.values[_OWN]
        amounts[0], columns[:, 0] = unit * amounts[0], columns[:, 0] / unit
        known = self.likelihood.noise.standard_deviation / np.linalg.norm(columns, axis=0)
        model = model.with_values(
            *(dict(zip((_OWN, *paths), map(float, numbers), strict=True)) for numbers in (amounts, known))
        )
        residual = self.measured - columns @ amounts
        evaluation = evaluation_of_runs(
            [Run(f"run {n}", np.arange((self.runs == n).sum()) / 120.0) for n in np.unique(self.runs)],
            residual,
            self.measured - residual,
            columns,
            (_OWN, *paths),
            model,
        )
        return FittedSet(
            {n: self.candidates[n] for n in chosen}, FittedModel(model, evaluation, at_bound, ())
        )

    def columns(self, about: FittedSet) -> dict[str, CandidateColumns]:
        """Every candidate that a fitted set has not, linearised at a size of 0.1 beside it."""
        found = {}
        for name, own in self.series.items():
            if name not in about.names:
                (p,) = self.candidates[name].parameters
                path, ends = f"{name}.size", (np.array([p.lower - 0.1]), np.array([p.upper - 0.1]))
                found[name] = CandidateColumns(
                    self.candidates[name], {path: 0.1}, (path,), 0.1 * own, own[:, None], *ends
                )
        return found

    def logarithm(self, names: Iterable[str]) -> float:
        """Of the likelihood of a set, by generalised least squares."""
        return self.likelihood.whitened(self.fitted(names)).logarithm

    def judged(self, sets: Iterable[FittedSet]) -> dict[Names, Judged]:
        """Fitted sets in the one currency."""
        white = {one.names: (one, self.likelihood.whitened(one)) for one in sets}
        return {
            names: Judged(one, w, leave_one_run_out(w, self.measured, POLICY.prior_runs))
            for names, (one, w) in white.items()
        }

    def choice(
        self,
        sets: Collection[Iterable[str]],
        is_law: Callable[[Names], bool] = lambda names: True,
        on_edge: Collection[Names] = (),
        threshold: float = 5.0,
    ) -> Choice:
        """The answer among these sets. on_edge: those of which every value ended on a bound."""
        known = [
            self.fitted(s, tuple(f"{n}.size" for n in s) if frozenset(s) in on_edge else ()) for s in sets
        ]
        return choose(self.judged(known), POLICY, threshold, not_excused, self._likeness, is_law)

    def _likeness(self, one: str, other: str) -> float:
        first, second = self.series[one], self.series[other]
        return abs(float(first @ second)) / float(np.linalg.norm(first) * np.linalg.norm(second))

    def _centred(self, series: np.ndarray) -> np.ndarray:
        out = np.array(series, dtype=float)
        for run in np.unique(self.runs):
            out[self.runs == run] -= out[self.runs == run].mean()
        return out
