# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""`bench_fits`: does a fit reach the likelihood of the truth, from its standard starts and from the true values?

Of every effect that has a place or a time, at five sizes over its range.
"""

import argparse
from concurrent.futures import Executor
from dataclasses import dataclass

import numpy as np
from hasel_common.names import nearest_name
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sim.parallel import executor
from hasel_sysid.dataset import prepared
from hasel_sysid.estimation import FittedModel, fit_baseline
from hasel_sysid.noise_bounds import known_noise
from hasel_sysid.policy import POLICY
from hasel_sysid.problem import Problem
from hasel_sysid.selection.likelihood import Likelihood

from hasel_benchmark.bench_hidden.hidden_cases import Case, listed_effects
from hasel_benchmark.bench_hidden.laboratory import measure
from hasel_benchmark.benchmark_commands import told
from hasel_benchmark.errors import BenchmarkError

SHARES = (0.05, 0.2, 0.4, 0.7, 1.0)
"""Of the way from an effect's null to the end of its plausible range."""


@dataclass(frozen=True)
class FitOutcome:
    """hidden, from_starts, from_truth: values of the effect's parameters, as they are and as fits find them from the
    standard starts and from the true values; missed_*: by how much log-likelihood a fit ends below the truth, all other
    parameters fitted there too.
    """

    effect: str
    share: float
    hidden: dict[str, float]
    from_starts: dict[str, float]
    from_truth: dict[str, float]
    missed_from_starts: float
    missed_from_truth: float

    @property
    def both_reach_it(self) -> bool:
        """Whether neither fit can be told from the truth by its likelihood."""
        return max(self.missed_from_starts, self.missed_from_truth) <= np.log(POLICY.odds)

    def __str__(self) -> str:
        word = "ok    " if self.both_reach_it else "MISSED"
        return (
            f"{word} {self.effect} at {self.share:.0%} of its range: {_told(self.hidden)}; from its starts "
            f"{_told(self.from_starts)}, {self.missed_from_starts:+.1f} below; from the truth "
            f"{_told(self.from_truth)}, {self.missed_from_truth:+.1f} below"
        )


def effects_with_coordinates() -> tuple[str, ...]:
    """Ids of the effects of the swimmer that have a place or a time."""
    return tuple(e for e in listed_effects() if any(p.scan for p in catalogue()[e].parameters))


def fit_case(effect: str, share: float, seed: int, pool: Executor) -> FitOutcome:
    """Fit a model with the effect to a truth of another mesh, step and muscle law, in white noise.

    An effect with which no truth can be simulated is weaker (as strong effects of `bench_hidden` are).
    """
    first = catalogue()[effect].parameters[0]
    end = max((first.lower, first.upper), key=lambda bound: abs(bound - first.null))
    size = share * (end - first.null) / (first.typical - first.null)
    laboratory = measure(Case("strong", (effect,), size, seed, "white", "near"), pool)
    hidden = {f"{effect}.{name}": value for name, value in laboratory.values[effect].items()}
    problem = Problem(laboratory.fitted, pool)
    model = prepared(load_model("swimmer"), laboratory.fitted).with_effects(effect)
    true = model.with_values(hidden)
    truth = fit_baseline(problem, true.with_held(*hidden))
    from_starts, from_truth = (fit_baseline(problem, begin) for begin in (model, true))
    best, one, other = _logarithms(problem, [truth, from_starts, from_truth])
    return FitOutcome(
        effect,
        share,
        hidden,
        {name: from_starts.model.values[name] for name in hidden},
        {name: from_truth.model.values[name] for name in hidden},
        best - one,
        best - other,
    )


def _logarithms(problem: Problem, fits: list[FittedModel]) -> list[float]:
    """Of the likelihood of fits under one covariance."""
    evaluations = [fit.evaluation for fit in fits]
    noise = known_noise(problem, evaluations)
    likelihood = Likelihood(noise, evaluations[0].runs, problem.discrepancy)
    return [likelihood.of(one.residual, one.jacobian).logarithm for one in evaluations]


def _told(values: dict[str, float]) -> str:
    return ", ".join(f"{name.partition('.')[2]} {value:.3g}" for name, value in values.items())


def run(options: argparse.Namespace) -> int:
    """Run the command with these options; returns its exit code.

    Raises BenchmarkError for an effect that has neither place nor time.
    """
    every = effects_with_coordinates()
    for name in options.effects or ():
        if name not in every:
            raise BenchmarkError(f"'{name}' has neither place nor time; {nearest_name(name, every)}.")
    sizes = [(effect, share) for effect in options.effects or every for share in SHARES]
    with executor(options.jobs) as pool:
        outcomes = told((fit_case(*size, options.seed, pool) for size in sizes), options.json)
    reached = sum(outcome.both_reach_it for outcome in outcomes)
    print(
        f"{reached} of {len(outcomes)} fits end as likely as the truth from both starts ({reached / len(outcomes):.0%};"
        " bar: 98 %)"
    )
    return 0
