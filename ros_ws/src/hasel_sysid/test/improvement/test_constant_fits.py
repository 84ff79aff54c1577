"""Fits of a model with one constant free, in a world in which density moves a body as two effects do."""

import pytest
from hasel_sysid.estimation import fit_least_squares
from hasel_sysid.improvement.constant_fits import ConstantFits
from hasel_sysid.policy import POLICY
from hasel_sysid.testing.made_up_world import MadeUpWorld

DENSITY = "material.density_kg_per_m3"
TRUTH = 1080.0


@pytest.fixture
def problem():
    """Runs of a body that is a fifth denser than its file says."""
    world = MadeUpWorld(1, shared=16, constants={DENSITY: ("payload", "pre_bend")})
    return world.measured(world.with_typical().with_freed(DENSITY).with_values({DENSITY: TRUTH}))


def fits_of(problem):
    """Beside the baseline, with the squares of noise alone."""
    fitted = fit_least_squares(problem, problem.world.model).evaluation
    noise = fit_least_squares(problem, problem.world.model.with_freed(DENSITY)).evaluation.sum_of_squares
    problem.evaluations = 0
    return ConstantFits(problem, fitted, POLICY), noise


def test_the_constant_that_is_wrong_is_fitted(problem):
    """To its true value, at which noise alone is left."""
    fits, noise = fits_of(problem)
    found = fits.promising(noise, noise)
    assert DENSITY in found
    assert found[DENSITY].model.values[DENSITY] == pytest.approx(TRUTH, rel=0.02)
    assert found[DENSITY].evaluation.sum_of_squares == pytest.approx(noise, rel=1e-3)


def test_each_is_fitted_once(problem):
    """Against a second set of effects only what promises is asked anew."""
    fits, noise = fits_of(problem)
    found, spent = fits.promising(noise, noise), problem.evaluations
    again = fits.promising(2 * noise, noise)
    assert again[DENSITY] is found[DENSITY]
    assert problem.evaluations < 2 * spent - found[DENSITY].iterations


def test_what_comes_near_no_description_is_not_fitted_to_its_end(problem):
    """Where hardly any squares are allowed, the fit of the best constant ends sooner than where all of them are."""
    evaluations = []
    for allowed in (1e-6, 1.0):
        fits, noise = fits_of(problem)
        fits.promising(noise, allowed * noise)
        evaluations.append(problem.evaluations)
    assert evaluations[0] < evaluations[1]


def test_beside_no_time_none_is_fitted(problem):
    """Where the search's time is over, nothing is looked at."""
    fits, noise = fits_of(problem)
    problem.time_limit.seconds = -1.0
    assert fits.promising(noise, noise) == {}
