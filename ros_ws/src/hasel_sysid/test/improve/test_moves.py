"""Which other sets of effects promise more, before anything is fitted."""

import pytest
from hasel_sysid.diagnosis import diagnose
from hasel_sysid.fit import fit_least_squares
from hasel_sysid.improve.moves import moves
from hasel_sysid.testing.made_up_world import MadeUpWorld

HIDDEN = ("quadratic_drag", "pre_bend")


@pytest.fixture(scope="module")
def world():
    """Two effects are hidden in it."""
    return MadeUpWorld(3)


@pytest.fixture(scope="module")
def problem(world):
    """The runs as measured."""
    return world.measured(world.with_typical(*HIDDEN))


def looked_at(problem, model):
    """Fit and diagnosis of a model."""
    fit = fit_least_squares(problem, model, drafts=False)
    return fit, diagnose(problem, fit)


def test_the_hidden_pair_promises_most(world, problem):
    """And it is foretold to leave about what a fit of it leaves."""
    fit, found = looked_at(problem, world.model)
    best = moves(fit.evaluation, found.context.trials, (), room=3)[0]
    assert set(best.add) == set(HIDDEN)
    fitted = fit_least_squares(
        problem, fit.model.with_effects(*best.add).with_values(best.values), drafts=False
    )
    assert best.squares == pytest.approx(fitted.evaluation.sum_of_squares, rel=0.05)


@pytest.fixture(scope="module")
def wrong(world, problem):
    """The same runs, and a model with an effect that is not there."""
    return looked_at(problem, world.model.with_effects("gravity_tilt"))


def test_a_wrong_first_effect_gives_way_to_the_right_pair(wrong):
    """Two for one: no single addition gets there."""
    fit, found = wrong
    best = moves(fit.evaluation, found.context.trials, ("gravity_tilt",), room=1)[0]
    assert (best.drop, set(best.add)) == (("gravity_tilt",), set(HIDDEN))
    assert str(best).startswith("without gravity_tilt, with ")


def test_no_move_leads_to_more_effects_than_there_is_room_for(wrong):
    """With no room, one may only take the place of another."""
    fit, found = wrong
    for move in moves(fit.evaluation, found.context.trials, ("gravity_tilt",), room=0):
        assert len(move.add) <= len(move.drop)
