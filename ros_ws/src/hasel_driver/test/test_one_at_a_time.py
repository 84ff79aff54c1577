"""The place for one experiment."""

import pytest
from hasel_driver.errors import RefusedError
from hasel_driver.one_at_a_time import PROMISE_S, OneAtATime


@pytest.fixture
def clock():
    """A clock that stands until it is set: its only entry [s]."""
    return [0.0]


@pytest.fixture
def place(clock):
    """A place at that clock."""
    return OneAtATime(lambda: clock[0])


def test_is_promised_once_before_it_is_taken(place):
    """Two goals that arrive before the first has begun: the second is turned away."""
    assert (place.promise(), place.promise()) == (True, False)


def test_is_kept_while_taken_and_free_afterwards(place, clock):
    """However long the first takes."""
    place.promise()
    with place.taken():
        clock[0] += 10 * PROMISE_S
        assert not place.promise()
    assert place.promise()


def test_is_free_again_after_a_failure(place):
    """An experiment that raises does not keep others out."""
    with pytest.raises(OSError, match="full"), place.taken():
        raise OSError("the disk is full")
    assert place.promise()


def test_promise_lapses(place, clock):
    """An accepted goal that never begins does not keep others out for ever."""
    place.promise()
    clock[0] += PROMISE_S
    assert place.promise()


def test_late_goal_is_refused_while_another_runs(place):
    """In words: its promise had lapsed, and another took the place."""
    with place.taken(), pytest.raises(RefusedError, match="Another experiment is running"), place.taken():
        pass
