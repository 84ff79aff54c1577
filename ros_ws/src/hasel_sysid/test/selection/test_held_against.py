"""What a fit is held against."""

import math

from hasel_sysid.selection.held_against import NEAR, HeldAgainst


def _goal(against: HeldAgainst, fit: str, begun: float = math.inf, worth: float = math.inf) -> float:
    return against.goal(fit, begun, worth)


def test_a_fit_is_held_against_the_least_that_was_left_before():
    """The first of all against nothing."""
    against = HeldAgainst()
    assert math.isinf(_goal(against, "first"))
    for squares in (2.0, 1.0, 3.0):
        against.learn(squares)
    assert _goal(against, "later") == NEAR * 1.0


def test_what_was_foreseen_is_held_against_what_was_known_then():
    """Where there are processes for it, it was begun then: with one process it must end likewise."""
    against = HeldAgainst()
    against.learn(5.0)
    assert [_goal(against, fit) / NEAR for fit in ("next", "after")] == [5.0, 5.0]
    against.learn(1.0)
    assert [_goal(against, fit) / NEAR for fit in ("next", "after", "last")] == [5.0, 5.0, 1.0]


def test_a_fit_is_not_held_against_less_than_what_it_begins_with_needs():
    """Near the set that it begins with, where nothing better is known; a larger set also has to be worth anything."""
    against = HeldAgainst()
    assert _goal(against, "part", begun=3.0) == NEAR * 3.0
    assert _goal(against, "larger", begun=3.0, worth=2.7) == 2.7
    against.learn(0.1)
    assert _goal(against, "later", begun=3.0, worth=2.7) == NEAR * 0.1
