# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The order in which tasks are handed on to processes."""

from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Executor, Future, ThreadPoolExecutor
from threading import Event, Thread

import pytest
from hasel_sim.parallel import SerialExecutor, Turn, Turns, all_at_once

PATIENCE_S = 20.0


class ByHand(Executor):
    """Notes what it is given; a test ends it when it wants to."""

    def __init__(self) -> None:
        self.given: list[tuple[str, Future]] = []

    def submit(self, function: Callable, /, *arguments, **keywords) -> Future:
        """What the call returns is its name."""
        future: Future = Future()
        self.given.append((function(*arguments, **keywords), future))
        return future

    @property
    def names(self) -> str:
        """Of all that was given so far."""
        return "".join(name for name, _ in self.given)

    def end(self, name: str, error: BaseException | None = None) -> None:
        """One of them is done."""
        future = dict(self.given)[name]
        if error is None:
            future.set_result(name)
        else:
            future.set_exception(error)


@pytest.fixture
def pool() -> ByHand:
    """Two processes."""
    return ByHand()


@pytest.fixture
def turns(pool) -> Turns:
    """Their turns."""
    return Turns(pool, 2)


def submit(turns: Turns, names: str, turn: Turn | None = None) -> list[Future]:
    """Tasks that are called by a letter each."""
    if turn is None:
        return [turns.submit(str, name) for name in names]
    with turns.within(turn):
        return submit(turns, names)


def test_what_is_asked_for_goes_first_as_many_at_once_as_there_are_processes(turns, pool):
    """What was only foreseen is begun when a process has nothing else to do."""
    asked = submit(turns, "abc")
    submit(turns, "x", turns.foreseen())
    submit(turns, "d")
    assert pool.names == "ab"
    pool.end("b")
    pool.end("a")
    assert pool.names == "abcd"
    pool.end("c")
    assert pool.names == "abcdx"
    assert [f.result() for f in asked] == ["a", "b", "c"]


def test_what_is_foreseen_leaves_a_process_free(turns, pool):
    """The next step of what is asked for would otherwise wait for a task that is never broken off."""
    submit(turns, "xy", turns.foreseen())
    assert pool.names == "x"
    submit(turns, "a")
    assert pool.names == "xa"
    pool.end("x")
    assert pool.names == "xay"


def test_what_was_foreseen_first_goes_first(turns, pool):
    """The likeliest is foreseen first."""
    first, second = turns.foreseen(), turns.foreseen()
    submit(turns, "ab")
    submit(turns, "y", second)
    submit(turns, "x", first)
    pool.end("a")
    assert pool.names == "abx"


def test_what_is_asked_for_later_goes_before_what_is_still_foreseen(turns, pool):
    """And need leave no process free."""
    first, second = turns.foreseen(), turns.foreseen()
    submit(turns, "x", first)
    submit(turns, "yz", second)
    assert pool.names == "x"
    turns.ask(second)
    assert pool.names == "xy"
    pool.end("x")
    assert pool.names == "xyz"


def test_a_turn_is_of_one_thread(turns, pool):
    """Another thread asks at the same time."""
    with turns.within(turns.foreseen()):
        submit(turns, "x")
        other = Thread(target=submit, args=(turns, "a"))
        other.start()
        other.join(PATIENCE_S)
        submit(turns, "y")
        pool.end("x")
        submit(turns, "z")
    submit(turns, "b")
    assert pool.names == "xay"
    pool.end("a")
    assert pool.names == "xayb"


def test_an_error_of_a_task_is_its_own(turns, pool):
    """The others go on."""
    one, other, last = submit(turns, "abc")
    pool.end("a", ValueError("wrong"))
    with pytest.raises(ValueError, match="wrong"):
        one.result()
    pool.end("b")
    pool.end("c")
    assert (other.result(), last.result()) == ("b", "c")


def test_where_a_process_was_lost_all_that_waits_fails(turns, pool):
    """An executor that has broken is not called from where it tells so: it may hold its lock there."""
    _, _, waiting = submit(turns, "abc")
    pool.end("a", BrokenExecutor("lost"))
    with pytest.raises(BrokenExecutor, match="lost"):
        waiting.result(timeout=PATIENCE_S)
    assert pool.names == "ab"


def test_where_the_executor_has_ended_a_task_says_so():
    """Instead of waiting for ever."""
    pool = ThreadPoolExecutor(2)
    pool.shutdown()
    with pytest.raises(RuntimeError, match="after shutdown"):
        Turns(pool, 2).submit(abs, -1).result(timeout=PATIENCE_S)


@pytest.fixture
def threads() -> Iterator[Turns]:
    """Two that work."""
    with ThreadPoolExecutor(2) as pool:
        yield Turns(pool, 2)


def test_calls_are_made_at_once_where_there_are_processes(threads):
    """Each of them waits for the other; results come in the order of the calls."""
    met = Event(), Event()

    def call(own: int) -> int:
        met[own].set()
        assert met[1 - own].wait(PATIENCE_S)
        return threads.submit(abs, -own).result()

    assert all_at_once(threads, [lambda: call(0), lambda: call(1)]) == [0, 1]


def test_calls_are_made_one_after_the_other_in_a_single_process():
    """There, at once would only take longer."""
    seen = []
    assert all_at_once(SerialExecutor(), [lambda: seen.append(0), lambda: seen.append(1)]) == [None, None]
    assert seen == [0, 1]
