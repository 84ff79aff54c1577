"""Deeper valleys elsewhere on the body."""

import numpy as np
import pytest
from hasel_recording import Recording
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import load_model
from hasel_sim.parallel import SerialExecutor
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from hasel_sysid.dataset import Experiment
from hasel_sysid.estimation import fit_least_squares
from hasel_sysid.problem import Problem
from hasel_sysid.selection.other_valleys import Drafts, deepest

STIFFNESS, POSITION = "tether.stiffness", "tether.position"
HIDDEN = {STIFFNESS: 10.28, POSITION: 0.0784}


@pytest.fixture(scope="module")
def tethered():
    """A swimmer held near its middle, half a period to either side; runs, and a model that knows all but the tether."""
    model = load_model("swimmer").with_levels([5500.0]).with_effects("tether")
    model = model.with_values({"amplitude_5500": 0.06, "slope": 0.27, **HIDDEN})
    drive = DriveSchedule(np.array([0.0, 1.0]), np.array([[5500.0, 0.0], [0.0, 5500.0]]))
    run = Run("held", np.arange(240) / 120, drive)
    series = simulate(model.with_numerics(steps_per_second=480.0), run).sin_theta
    recording = Recording("held", run.time, series, drive_signal=drive.at(run.time))
    return Problem([Experiment(recording, run)], SerialExecutor()), model


def test_a_tether_in_the_wrong_place_is_found_where_it_is(tethered):
    """Near the nose a weaker one looks alike, and no derivative leads from there to the middle."""
    problem, model = tethered
    lost = fit_least_squares(problem, model.with_values({STIFFNESS: 3.0, POSITION: 0.007}), drafts=False)
    assert lost.model.values[POSITION] < 0.03
    found = deepest(problem, lost, {"tether"}, 25)
    assert found.evaluation.sum_of_squares < lost.evaluation.sum_of_squares
    assert found.model.values[POSITION] == pytest.approx(HIDDEN[POSITION], rel=0.02)
    assert found.model.values[STIFFNESS] == pytest.approx(HIDDEN[STIFFNESS], rel=0.05)


def test_a_fit_without_places_is_left_as_it_is(tethered):
    """Nothing is simulated for it."""
    problem, model = tethered
    fit = fit_least_squares(problem, model.without_effects("tether"), most_evaluations=3, drafts=False)
    before = problem.evaluations
    assert deepest(problem, fit, {"tether"}, 25) is fit
    assert problem.evaluations == before


def test_drafts_are_exact_at_the_model_that_is_known(tethered):
    """What they get wrong there is taken out, and the models that come back are those that were given."""
    problem, model = tethered
    known = problem.evaluate(model, (STIFFNESS,))
    again = Drafts(problem, known).evaluate(model, (STIFFNESS,))
    assert again.residual == pytest.approx(known.residual, abs=1e-12)
    assert again.model is model
