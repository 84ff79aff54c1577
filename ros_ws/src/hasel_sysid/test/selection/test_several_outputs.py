# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Several outputs of a frame in one residual: what one angle cannot tell apart, two can."""

import numpy as np
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.improvement import improve
from hasel_sysid.selection.likelihood import Likelihood
from hasel_sysid.testing.linear_world import SLOW
from hasel_sysid.testing.made_up_world import MadeUpWorld, TwoOutputs

TWINS = ("payload", "linear_drag")
LOUD = 0.05
WORLD, OTHER = MadeUpWorld(1, alike={"linear_drag": "payload"}), MadeUpWorld(2)


def test_two_outputs_tell_apart_what_one_cannot():
    """Two effects that look alike in one angle are one group; with an angle in which they do not, each is itself."""
    truth = WORLD.with_typical("payload")
    alone = improve(WORLD.measured(truth, LOUD), WORLD.model, only=TWINS)
    assert [set(group) for group in alone.diagnosis.groups] == [set(TWINS)]
    both = improve(TwoOutputs(WORLD, OTHER, truth, LOUD), WORLD.model, only=TWINS)
    assert both.missing == ("payload",)
    assert both.diagnosis.groups == []


def test_every_output_of_every_run_has_an_offset_of_its_own():
    """Runs stay what is left out: two outputs of one run are no two runs."""
    problem = TwoOutputs(WORLD, OTHER, WORLD.with_typical())
    evaluation = fit_baseline(problem, WORLD.model).evaluation
    count = len(problem.experiments)
    assert len(np.unique(evaluation.runs)) == count and len(np.unique(evaluation.series)) == 2 * count
    means = [evaluation.residual[evaluation.series == one].mean() for one in range(2 * count)]
    np.testing.assert_allclose(means, 0.0, atol=1e-12)
    assert evaluation.offsets.shape == (2 * count,)
    part = evaluation.of_runs([1, 3])
    np.testing.assert_array_equal(part.offsets, evaluation.offsets[[2, 3, 6, 7]])
    np.testing.assert_array_equal(part.simulated(), evaluation.simulated()[np.isin(evaluation.runs, [1, 3])])


def test_a_frame_of_which_one_output_is_missing_keeps_the_other():
    """A marker that is hidden takes no other marker's frames with it."""
    problem = TwoOutputs(WORLD, OTHER, WORLD.with_typical())
    whole = problem.evaluate(WORLD.model)
    problem.experiments[0].other.sin_theta[10:20] = np.nan
    part = problem.evaluate(WORLD.model)
    assert len(part.residual) == len(whole.residual) - 10
    np.testing.assert_allclose(part.residual[part.series == 0], whole.residual[whole.series == 0])


def test_the_likelihood_of_two_outputs_is_that_of_two_series():
    """Outputs share no noise: the logarithms add, as those of runs do."""
    evaluation = fit_baseline(TwoOutputs(WORLD, OTHER, WORLD.with_typical()), WORLD.model).evaluation
    likelihood = Likelihood(SLOW, evaluation.runs, series=evaluation.series)
    nothing = np.zeros((len(evaluation.residual), 0))
    whole = likelihood.of(evaluation.residual, nothing).logarithm
    parts = 0.0
    for one in np.unique(evaluation.series):
        here = evaluation.series == one
        alone = Likelihood(SLOW, np.zeros(here.sum(), dtype=int))
        parts += alone.of(evaluation.residual[here], nothing[here]).logarithm
    np.testing.assert_allclose(whole, parts)
