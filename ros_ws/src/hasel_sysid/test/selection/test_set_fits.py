"""What a fit of a set of effects is asked for."""

import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sysid.estimation import fit_least_squares
from hasel_sysid.estimation.least_squares import fitted_result
from hasel_sysid.policy import POLICY
from hasel_sysid.selection.held_against import NEAR
from hasel_sysid.selection.simulated_sets import SimulatedSets

BENT, DRAG = frozenset({"pre_bend"}), frozenset({"linear_drag"})


@pytest.fixture
def asked(monkeypatch):
    """Options of every fit that was made, in order."""
    options: list[dict] = []

    def fitted(*arguments, **given):
        options.append(given)
        return fit_least_squares(*arguments, **given)

    monkeypatch.setattr("hasel_sysid.selection.set_fits.fit_least_squares", fitted)
    return options


def _sets(bent_swimmer, slack=()) -> SimulatedSets:
    problem, evaluation = bent_swimmer
    effects = [catalogue()[name] for name in (*BENT, *DRAG)]
    return SimulatedSets(problem, fitted_result(evaluation, 1), effects, slack)


def _fit(sets: SimulatedSets, effects, near):
    (new,) = effects - near.effects
    seen = sets.prospects(near, [new], lambda p: -float(p.residual @ p.residual), 0)
    return sets.fit(effects, near, list(seen.values()))


def test_a_larger_set_has_to_take_away_what_matters(bent_swimmer, asked):
    """Of the squares of the set that it is larger than, and it has to come near the best one."""
    sets = _sets(bent_swimmer)
    bent = _fit(sets, BENT, sets.baseline())
    base = sets.baseline().squares
    assert bent.squares < 0.1 * base
    assert asked[0]["goal"] == pytest.approx((1 - POLICY.matters) * base)
    asked.clear()
    _fit(sets, DRAG, sets.baseline())
    assert asked[0]["goal"] == pytest.approx(NEAR * bent.squares)
    asked.clear()
    _fit(sets, BENT | DRAG, bent)
    assert asked[0]["goal"] == pytest.approx((1 - POLICY.matters) * bent.squares)


def test_what_every_set_misses_need_not_be_taken_away(bent_swimmer, asked):
    """Where finer numerics would take away all of it, hardly anything has to be."""
    base = _sets(bent_swimmer).baseline()
    sets = _sets(bent_swimmer, [base.residual])
    _fit(sets, DRAG, sets.baseline())
    assert asked[0]["goal"] == pytest.approx(base.squares)


def test_a_set_that_was_simulated_at_its_start_is_not_simulated_there_again(bent_swimmer, asked):
    """A part of a set is fitted from the values of the others, at which it is known."""
    sets = _sets(bent_swimmer)
    both = _fit(sets, BENT | DRAG, _fit(sets, BENT, sets.baseline()))
    asked.clear()
    left = sets.without(both, "linear_drag")
    part = sets.fit(BENT, left, ())
    assert asked[0]["begun"] is left.fit.evaluation
    assert asked[0]["goal"] == pytest.approx(NEAR * min(both.squares, left.squares))
    assert part.squares <= left.squares
