"""What a fit is held against."""

import math

from hasel_sysid.selection.held_against import HeldAgainst


def test_a_fit_is_held_against_the_least_that_was_left_before():
    """The first of all against nothing."""
    against = HeldAgainst()
    assert math.isinf(against.of("first"))
    for squares in (2.0, 1.0, 3.0):
        against.learn(squares)
    assert against.of("later") == 1.0


def test_what_was_foreseen_is_held_against_what_was_known_then():
    """Where there are processes for it, it was begun then: with one process it must end likewise."""
    against = HeldAgainst()
    against.learn(5.0)
    assert [against.of(fit) for fit in ("next", "after")] == [5.0, 5.0]
    against.learn(1.0)
    assert [against.of(fit) for fit in ("next", "after", "last")] == [5.0, 5.0, 1.0]
