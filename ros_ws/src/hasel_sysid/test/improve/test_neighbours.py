"""The best set next to a given one."""

from hasel_sysid.diagnosis import diagnose
from hasel_sysid.fit import fit_least_squares
from hasel_sysid.improve.neighbours import best_neighbour
from hasel_sysid.testing.made_up_world import MadeUpWorld


def neighbour(world, hidden, present=(), stranger=0.0):
    """The best set next to the present one, when these effects are hidden."""
    problem = world.measured(world.with_typical(*hidden), stranger=stranger)
    model = world.model.with_effects(*present) if present else world.model
    fit = fit_least_squares(problem, model, drafts=False)
    found = diagnose(problem, fit)
    single = None if found.best is None else found.best.fit
    return best_neighbour(problem, fit, found, single, present, most_effects=3)


def names(fit):
    """Effects of a fit."""
    return {effect.id for effect in fit.model.effects}


def test_two_at_once_are_taken_where_they_explain():
    """Two effects of like strength."""
    assert names(neighbour(MadeUpWorld(3), ("quadratic_drag", "pre_bend"))) == {"quadratic_drag", "pre_bend"}


def test_a_wrong_effect_is_exchanged():
    """It stood in the place of the two that are there."""
    found = neighbour(MadeUpWorld(3), ("quadratic_drag", "pre_bend"), present=("gravity_tilt",))
    assert names(found) == {"quadratic_drag", "pre_bend"}


def test_two_that_imitate_a_part_of_a_stranger_are_not():
    """Of any two effects one may hope that they do."""
    found = neighbour(MadeUpWorld(5, shared=16), (), stranger=0.02)
    assert found is None or len(names(found)) < 2


def test_the_right_set_stays():
    """There is nothing better next to it."""
    assert neighbour(MadeUpWorld(3), ("quadratic_drag",), present=("quadratic_drag",)) is None
