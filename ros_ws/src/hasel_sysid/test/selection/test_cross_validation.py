# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Elpd of left-out runs, against the predictive density computed run by run."""

import numpy as np
import pytest
from hasel_sysid.projection import orthonormal
from hasel_sysid.selection.cross_validation import Elpd, leave_one_run_out
from hasel_sysid.selection.likelihood import Whitened
from scipy.stats import multivariate_normal

RUNS = np.repeat(np.arange(5), 12)
PRIOR_RUNS = 0.1


def fitted(columns, series):
    """White noise of variance one, without offsets."""
    basis = orthonormal(columns)
    return Whitened(series - basis @ (basis.T @ series), basis, RUNS, RUNS)


def test_it_is_the_density_of_every_run_given_the_others():
    """Bayes with the information of a tenth of an average run about every parameter, where the fit to all runs is."""
    generator = np.random.default_rng(2)
    columns, series = generator.standard_normal((60, 3)), generator.standard_normal(60)
    values = np.linalg.lstsq(columns, series, rcond=None)[0]
    prior = PRIOR_RUNS / 5 * columns.T @ columns
    expected = []
    for run in range(5):
        here, others = run == RUNS, run != RUNS
        information = columns[others].T @ columns[others] + prior
        mean = np.linalg.solve(information, columns[others].T @ series[others] + prior @ values)
        spread = np.eye(12) + columns[here] @ np.linalg.solve(information, columns[here].T)
        density = multivariate_normal(columns[here] @ mean, spread).logpdf(series[here])
        expected.append(density + 6 * np.log(2 * np.pi))
    assert leave_one_run_out(fitted(columns, series), series, PRIOR_RUNS).densities == pytest.approx(expected)


def test_parameters_that_help_nobody_cost():
    """The more of them, the less runs left out are foretold, though all runs are fitted better."""
    generator = np.random.default_rng(3)
    useless, series = generator.standard_normal((60, 6)), generator.standard_normal(60)
    few, many = (fitted(useless[:, :n], series) for n in (1, 6))
    assert many.logarithm > few.logarithm
    assert (
        leave_one_run_out(many, series, PRIOR_RUNS).total < leave_one_run_out(few, series, PRIOR_RUNS).total
    )


def test_an_amplitude_that_one_run_alone_shows_costs_a_few_units_only():
    """No other run foretells it, so that run is foretold hardly worse than without it."""
    series = np.random.default_rng(4).standard_normal(60)
    own = np.where(RUNS == 2, np.sin(np.arange(60.0)), 0.0)
    nothing = fitted(np.zeros((60, 0)), series)
    cost = (
        leave_one_run_out(nothing, series, PRIOR_RUNS).total
        - leave_one_run_out(fitted(own[:, None], series), series, PRIOR_RUNS).total
    )
    assert 0.0 < cost < 5.0


def test_the_standard_error_of_a_gain_is_how_it_varies():
    """Over many draws of the noise, of two laws of which neither is the truth."""
    generator = np.random.default_rng(6)
    one, other = generator.standard_normal((2, 60, 1))
    gains = []
    for _ in range(400):
        series = 0.4 * (one + other)[:, 0] + generator.standard_normal(60)
        first, second = (
            leave_one_run_out(fitted(columns, series), np.ones(60), PRIOR_RUNS) for columns in (one, other)
        )
        gains.append(first.over(second))
    scatter = np.std([gain.total for gain in gains])
    assert np.mean([gain.by_noise for gain in gains]) == pytest.approx(scatter, rel=0.25)
    assert scatter < np.mean([gain.error for gain in gains]) < 1.6 * scatter


def test_runs_in_which_little_moves_are_no_disagreement():
    """Gains in proportion to the power of a run have no scatter; the same gains of runs of one power have much."""
    power = np.array([1.0, 4.0, 9.0, 16.0, 25.0])
    nothing, every = np.zeros(60), np.zeros(5)
    by_power, alike = (
        Elpd(gains * power, nothing, powers) for gains, powers in ((2.0, power), (2.0, every + 1))
    )
    assert by_power.over(Elpd(every, nothing, power)).error == pytest.approx(0.0, abs=1e-9)
    assert alike.over(Elpd(every, nothing, every + 1)).error == pytest.approx(
        5**0.5 * np.std(2 * power, ddof=1)
    )


def test_the_scatter_of_unequal_runs_is_how_their_sum_varies():
    """Gains with a variance in proportion to the power of their run, over many draws."""
    generator = np.random.default_rng(8)
    power = np.array([1.0, 4.0, 9.0, 16.0, 25.0])
    nothing = Elpd(np.zeros(5), np.zeros(60), power)
    drawn = 2.0 * power + np.sqrt(power) * generator.standard_normal((4000, 5))
    gains = [Elpd(gain, np.zeros(60), power).over(nothing) for gain in drawn]
    variance = np.var([gain.total for gain in gains])
    assert np.mean([gain.error**2 for gain in gains]) == pytest.approx(variance, rel=0.05)


def test_a_gain_of_every_run_is_one_however_much_a_single_run_gains():
    """Of few runs the scatter exceeds the sum where a small one gains most; where a run loses, they disagree."""
    power = np.array([1.0, 2.0, 2.0, 2.0])
    nothing = Elpd(np.zeros(4), np.zeros(60), power)
    for gains, better in (([12000.0, 200, 150, 100], True), ([12000.0, 200, 150, -1], False)):
        gain = Elpd(np.array(gains), np.zeros(60), power).over(nothing)
        assert gain.total < gain.error
        assert gain.exceeds(1.0) is better
