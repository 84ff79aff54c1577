# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is said of every effect, and the status that a search comes to."""

import numpy as np
import pytest
from hasel_sysid.answer.diagnosis import Verdict
from hasel_sysid.answer.result import Status
from hasel_sysid.answer.verdict import near_noise, share_left, status_with
from hasel_sysid.estimation import fit_baseline
from hasel_sysid.improvement import diagnose
from hasel_sysid.noise import NoiseModel
from hasel_sysid.testing.made_up_world import VOLTAGES, MadeUpWorld

FLOOR = 0.0024
NOISE_FLOOR = NoiseModel(white=0.5 * np.pi * FLOOR**2, coloured=0.0, correlation=0.5)


@pytest.mark.parametrize(
    ("before", "after", "looks_like_noise", "status"),
    [
        (0.0444, 0.0025, False, Status.EXPLAINED),
        (0.0444, 0.0029, False, Status.EXPLAINED),
        # nearly all of a large error is gone, but what is left is not noise
        (0.0444, 0.0036, True, Status.PARTLY_EXPLAINED),
        (0.0444, 0.0040, False, Status.PARTLY_EXPLAINED),
        (0.0444, 0.0077, False, Status.PARTLY_EXPLAINED),
        (0.0444, 0.0280, False, Status.UNEXPLAINED),
        # a weak effect: the share left is no more than the uncertainty of the noise
        (0.0030, 0.0026, True, Status.EXPLAINED),
        (0.0030, 0.0026, False, Status.PARTLY_EXPLAINED),
    ],
)
def test_status_follows_from_the_mean_error_above_the_noise(before, after, looks_like_noise, status):
    """Explained is what removes nine tenths of it and comes near the noise, or leaves what looks like noise there."""
    left = share_left(before, after, NOISE_FLOOR)
    assert status_with(left, near_noise(after, NOISE_FLOOR), looks_like_noise) is status


def test_the_share_left_is_of_the_error_above_the_noise():
    """One for no effect, none at the noise, in proportion between."""
    assert share_left(0.0424, 0.0424, NOISE_FLOOR) == 1.0
    assert share_left(0.0424, 0.9 * FLOOR, NOISE_FLOOR) == 0.0
    assert share_left(0.0424, 0.0224, NOISE_FLOOR) == pytest.approx(0.5, abs=0.01)


@pytest.fixture(scope="module")
def said():
    """A diagnosis where a payload is hidden, with an effect much alike, one that is not, and one fitted already."""
    world = MadeUpWorld(1, alike={"linear_drag": "payload"})
    problem = world.measured(world.with_typical("payload"))
    names = ("payload", "linear_drag", "pre_bend", "viscoelastic_creep")
    return diagnose(problem, fit_baseline(problem, world.model), only=names)


def test_the_chosen_effect_is_missing(said):
    """With its value and standard error, its probability, and the share of the error that it removes."""
    first = said.findings[0]
    assert (first.effect, first.verdict) == ("payload", Verdict.MISSING)
    value, error = first.expected["payload.mass"]
    assert abs(value - 0.01) < 3 * error < 0.003
    assert first.probability > 0.8 and first.error_removed > 0.9
    assert said.best is first and said.goodness.adequate
    assert said.probability_none < 0.2


def test_what_the_chosen_one_explains_accuses_no_other(said):
    """Beside it nothing is left for its double, which alone would remove nearly as much."""
    double = said.finding("linear_drag")
    assert double.verdict is Verdict.ABSENT
    assert double.error_removed > 0.5 and double.probability < 0.1


def test_what_would_have_shown_is_absent(said):
    """A typical size of another shape stands far above the noise, and so the limit of detection lies below it."""
    for name in ("pre_bend", "viscoelastic_creep"):
        found = said.finding(name)
        assert found.verdict is Verdict.ABSENT
        assert found.visible_above < abs(found.plausible[1])


def test_in_loud_noise_an_effect_is_undecided_or_cannot_be_seen():
    """A limit of detection above the typical size says nothing, one beyond the plausible range less than nothing."""
    world = MadeUpWorld(1)
    truth = world.with_typical().with_values({f"amplitude_{voltage:.0f}": 0.5 for voltage in VOLTAGES})
    problem = world.measured(truth, noise=0.45)
    said = diagnose(problem, fit_baseline(problem, truth), only=("payload", "drive_softening"))
    assert said.finding("payload").verdict is Verdict.INCONCLUSIVE
    assert said.finding("drive_softening").verdict is Verdict.CANNOT_BE_SEEN


def test_what_the_fitted_parameters_imitate_is_said():
    """An effect that does what an amplitude does."""
    world = MadeUpWorld(1, alike={"payload": "amplitude_3500"})
    problem = world.measured(world.with_typical())
    found = diagnose(problem, fit_baseline(problem, world.model), only=("payload", "pre_bend"))
    assert found.finding("payload").swallowed > 0.1
    assert found.finding("pre_bend").swallowed < found.finding("payload").swallowed


def test_of_no_error_above_the_noise_no_effect_removes_a_share():
    """Where nothing is hidden and the baseline leaves less than the noise, a removed share would be of nothing."""
    world = MadeUpWorld(3)
    problem = world.measured(world.model)
    baseline = fit_baseline(problem, world.model)
    found = diagnose(problem, baseline, only=("payload", "linear_drag", "pre_bend"))
    assert baseline.mean_absolute_error <= found.noise.mean_absolute
    assert {finding.error_removed for finding in found.findings} == {0.0}
