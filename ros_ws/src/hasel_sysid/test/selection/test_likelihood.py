# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The likelihood of correlated residuals, against the covariance written out."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.model import load_model
from hasel_sysid.candidates import Candidate
from hasel_sysid.estimation import FittedModel
from hasel_sysid.noise import LONGEST_CORRELATION, NoiseModel
from hasel_sysid.selection.likelihood import FittedSet, Likelihood, on_edge, out_of_range
from hasel_sysid.testing.made_up_runs import made_up_evaluation
from scipy.linalg import toeplitz
from scipy.stats import multivariate_normal

RUNS = np.repeat([0, 1], [40, 25])
NOISE = NoiseModel(0.5, 2.0, 0.8)
DISCREPANCY = 0.7
NAME, ERROR = "force_length.weakening", 0.03
WEAKENING = Candidate("force_length", catalogue()["force_length"].parameters, catalogue()["force_length"])


def covariance(count, slack=None):
    """Of the frames of one run."""
    lag = np.arange(count)
    first = NOISE.coloured * NOISE.correlation**lag + DISCREPANCY**2 * LONGEST_CORRELATION**lag
    first[0] += NOISE.white
    return toeplitz(first) + (0.0 if slack is None else slack @ slack.T)


@pytest.fixture
def generator():
    """Seeded."""
    return np.random.default_rng(5)


@pytest.mark.parametrize("finer", [0, 2])
def test_differences_of_the_logarithm_are_those_of_the_density(generator, finer):
    """Of two series without their run's mean, where an offset of any size is as likely as any other."""
    slack = generator.standard_normal((len(RUNS), finer))
    likelihood = Likelihood(NOISE, RUNS, DISCREPANCY, list(slack.T))
    series = generator.standard_normal((len(RUNS), 2))
    ours = -0.5 * (likelihood.whiten(series) ** 2).sum(axis=0)
    theirs = np.zeros(2)
    for run in (0, 1):
        here = run == RUNS
        # a proper prior so wide that it is none
        full = covariance(here.sum(), slack[here]) + 1e6
        theirs += [multivariate_normal(cov=full).logpdf(series[here, n]) for n in (0, 1)]
    assert ours[0] - ours[1] == pytest.approx(theirs[0] - theirs[1], rel=1e-4)


def test_what_was_set_once_is_one_error_of_all_runs(generator):
    """Such as a zero, where the offset of a run is known otherwise."""
    zero = 0.4 * np.ones(len(RUNS))
    likelihood = Likelihood(NOISE, RUNS, DISCREPANCY, shared=[zero], free_offset=False)
    series = generator.standard_normal((len(RUNS), 2)) + 1.0
    ours = -0.5 * (likelihood.whiten(series) ** 2).sum(axis=0)
    full = np.zeros((len(RUNS), len(RUNS)))
    for run in (0, 1):
        here = np.flatnonzero(run == RUNS)
        full[np.ix_(here, here)] = covariance(len(here))
    theirs = [multivariate_normal(cov=full + np.outer(zero, zero)).logpdf(series[:, n]) for n in (0, 1)]
    assert ours[0] - ours[1] == pytest.approx(theirs[0] - theirs[1], rel=1e-4)


def test_an_offset_of_a_run_changes_nothing(generator):
    """It is a nuisance."""
    likelihood = Likelihood(NOISE, RUNS, DISCREPANCY)
    series = generator.standard_normal(len(RUNS))
    moved = series + np.where(RUNS == 1, 3.0, -1.0)
    assert likelihood.whiten(moved) == pytest.approx(likelihood.whiten(series), abs=1e-9)


def test_noise_becomes_independent_and_of_variance_one(generator):
    """All of it but the offset of either run."""
    likelihood = Likelihood(NOISE, RUNS)
    draws = likelihood.whiten(NOISE.sample(RUNS, 4000, generator))
    spread = np.cov(draws)
    assert np.trace(spread) == pytest.approx(len(RUNS) - 2, rel=0.02)
    assert np.abs(spread - np.diag(np.diag(spread))).max() < 0.12


def test_what_is_fitted_can_follow_the_step_from_least_squares_to_generalised(generator):
    """The likelihood at its maximum over the parameters, wherever least squares has left them."""
    likelihood = Likelihood(NOISE, RUNS, DISCREPANCY)
    columns, series = generator.standard_normal((len(RUNS), 2)), generator.standard_normal(len(RUNS))
    moved = likelihood.of(series + columns @ [3.0, -1.0], columns)
    assert likelihood.of(series, columns).logarithm == pytest.approx(moved.logarithm)
    white = likelihood.whiten(np.column_stack([series, columns]))
    _, squares, *_ = np.linalg.lstsq(white[:, 1:], white[:, 0], rcond=None)
    assert moved.logarithm == pytest.approx(-0.5 * float(squares[0]))


def ended(value: float, pull: float, at_bound: bool = True, undetermined: bool = False) -> FittedModel:
    """A fit that left the weakening at a value, while the runs ask for so much more of it."""
    model = load_model("swimmer").with_levels([4500.0]).with_effects("force_length")
    model = model.with_values({NAME: value}, {NAME: None if undetermined else ERROR})
    series = np.sin(np.linspace(0.0, 6.0, 50))
    evaluation = made_up_evaluation(
        (pull * series)[None], np.arange(50) / 120, jacobian=series[:, None], names=(NAME,), model=model
    )
    return FittedModel(model, evaluation, (NAME,) if at_bound else (), (NAME,) if undetermined else ())


@pytest.mark.parametrize(
    ("value", "pull", "options", "out"),
    [
        (1.0, 0.5 * ERROR, {}, False),
        (1.0, 3 * ERROR, {}, True),
        (1.0, 0.0, {}, False),
        (0.0, -3 * ERROR, {}, False),
        (1.0, 10 * ERROR, {"undetermined": True}, False),
        (0.5, 10 * ERROR, {"at_bound": False}, False),
    ],
    ids=["beyond by noise", "surely beyond", "at its end", "not there", "not shown", "inside"],
)
def test_a_value_at_the_end_of_its_range_is_out_of_it_only_beyond_noise(value, pull, options, out):
    """What is hidden may lie at the end; an effect at its null is not there, whatever it would take."""
    assert out_of_range(WEAKENING, ended(value, pull, **options)) == out


@pytest.mark.parametrize(
    ("value", "options", "found"),
    [(1.0, {}, [NAME]), (1.0, {"undetermined": True}, []), (0.5, {"at_bound": False}, []), (0.0, {}, [])],
    ids=["at its end", "not shown", "inside", "not there"],
)
def test_a_value_is_on_the_edge_of_its_range_where_it_ended_there(value, options, found):
    """However little it would go on from there; what is not there, or not shown, is on no edge."""
    assert on_edge(WEAKENING, ended(value, 0.0, **options)) == found


@pytest.mark.parametrize("at_bound", [True, False])
def test_what_ended_on_a_bound_moves_no_more(at_bound):
    """Its set is on an edge, and still a plausible one."""
    found = FittedSet({"force_length": WEAKENING}, ended(1.0, 0.0, at_bound))
    assert found.on_edge == at_bound
    assert found.plausible
    assert found.jacobian.shape[1] == (0 if at_bound else 1)


def test_what_only_does_what_the_model_may_do_already_is_no_answer():
    """Such as a scale of the modulus beside a modulus that is free: the frames show their product alone."""
    assert FittedSet({"force_length": WEAKENING}, ended(0.5, 0.0, False)).plausible
    assert not FittedSet({"force_length": WEAKENING}, ended(0.5, 0.0, False, True)).plausible
