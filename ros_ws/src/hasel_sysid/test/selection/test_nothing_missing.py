# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The score test of whether anything is missing, against theory."""

import numpy as np
import pytest
from hasel_sysid.noise import NoiseModel
from hasel_sysid.selection.likelihood import Likelihood
from hasel_sysid.selection.nothing_missing import ScoreTest, score_test
from scipy.stats import chi2

NOISE = NoiseModel(0.2, 0.8, 0.9)
RUNS = np.repeat([0, 1, 2], 60)
LEVEL = 0.01


def result(series, looks, own=None) -> ScoreTest:
    """Of a model whose only parameter moves the series by `own`."""
    likelihood = Likelihood(NOISE, RUNS)
    own = np.zeros((len(RUNS), 0)) if own is None else own
    white = [(name, likelihood.whiten(look)) for name, look in looks.items()]
    return score_test(likelihood.of(series, own), white, LEVEL)


def test_twice_the_gain_of_one_effect_is_chi_squared():
    """With as many degrees as the effect has values; and so is the threshold of a single one."""
    generator = np.random.default_rng(1)
    look = {"effect": generator.standard_normal((len(RUNS), 2))}
    drawn = [result(series, look).gains["effect"] for series in NOISE.sample(RUNS, 300, generator).T]
    assert 2 * np.mean(drawn) == pytest.approx(2.0, rel=0.15)
    assert 2 * result(np.zeros(len(RUNS)), look).threshold == pytest.approx(chi2(2).ppf(1 - LEVEL), rel=0.25)


def test_many_effects_are_tested_as_one():
    """The chance is of the largest of twenty: under noise alone it is spread evenly."""
    generator = np.random.default_rng(2)
    looks = {str(n): generator.standard_normal((len(RUNS), 1)) for n in range(20)}
    chances = [result(series, looks).chance for series in NOISE.sample(RUNS, 40, generator).T]
    assert 0.35 < np.mean(chances) < 0.65
    assert min(chances) < 0.2


def test_what_the_parameters_imitate_is_no_gain():
    """However large it is."""
    own = np.random.default_rng(3).standard_normal((len(RUNS), 1))
    found = result(own[:, 0], {"the same": 5.0 * own, "another": np.roll(own, 7)}, own)
    assert found.gains["the same"] == pytest.approx(0.0, abs=1e-9)
    assert found.chance > LEVEL


def test_without_effects_nothing_is_missing():
    """There is nothing to test against."""
    assert result(np.ones(len(RUNS)), {}).chance == 1.0
