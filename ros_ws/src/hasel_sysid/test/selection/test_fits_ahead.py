"""Fits that are begun before they are asked for."""

from collections.abc import Callable
from concurrent.futures import CancelledError, ThreadPoolExecutor
from functools import partial
from threading import Event

import pytest
from hasel_sim.parallel import SerialExecutor
from hasel_sim.turns import Turns
from hasel_sysid.estimation import fit_least_squares
from hasel_sysid.problem import Problem
from hasel_sysid.selection.fits_ahead import FitsAhead

PATIENCE_S = 60.0


@pytest.fixture
def problem_with(bent_swimmer) -> Callable[[int], Problem]:
    """The bent swimmer's run, with so many threads in the place of processes to simulate it."""
    problem, _ = bent_swimmer

    def made(workers: int) -> Problem:
        pool = Turns(ThreadPoolExecutor(workers), workers) if workers > 1 else SerialExecutor()
        return Problem(problem.experiments, pool)

    return made


def test_a_fit_that_was_foreseen_is_not_made_again_and_ends_where_it_would_have(problem_with, bent_swimmer):
    """What was begun in the background is handed over when it is asked for."""
    problem, (_, evaluation) = problem_with(2), bent_swimmer
    calls = []

    def fit(of: Problem):
        calls.append(of)
        return fit_least_squares(of, evaluation.model, drafts=False, most_evaluations=3)

    ahead = FitsAhead(problem)
    ahead.foresee({"likely": fit})
    begun = ahead.done("likely", fit)
    assert len(calls) == 1
    alone = FitsAhead(problem_with(1)).done("likely", fit)
    assert begun.model.values == alone.model.values


def test_with_one_process_nothing_is_begun(problem_with):
    """What is begun there would only take the time of what is asked for."""
    ahead = FitsAhead(problem_with(1))
    ahead.foresee({"likely": lambda problem: pytest.fail("begun")})
    assert ahead.done("asked", lambda problem: "made") == "made"


def test_as_many_are_made_at_once_as_there_are_processes(problem_with):
    """The likeliest first; the next begins as soon as one of them has ended, though the other goes on."""
    ahead = FitsAhead(problem_with(2))
    started, may_end = ({name: Event() for name in "abc"} for _ in range(2))

    def fit(name: str, problem: Problem) -> str:
        started[name].set()
        assert may_end[name].wait(PATIENCE_S)
        return name

    ahead.foresee({name: partial(fit, name) for name in "abc"})
    assert all(started[name].wait(PATIENCE_S) for name in "ab")
    assert not started["c"].is_set()
    may_end["b"].set()
    assert started["c"].wait(PATIENCE_S)
    may_end["a"].set()
    may_end["c"].set()
    assert [ahead.done(name, lambda problem: pytest.fail("made again")) for name in "abc"] == list("abc")


def test_what_is_no_longer_likely_is_given_up(problem_with, bent_swimmer):
    """A fit that nobody will ask for simulates nothing more."""
    problem, (_, evaluation) = problem_with(2), bent_swimmer
    started, given_up, ended = Event(), Event(), Event()
    raised = []

    def fit(of: Problem) -> None:
        started.set()
        given_up.wait(PATIENCE_S)
        try:
            of.evaluate(evaluation.model)
        except CancelledError as error:
            raised.append(error)
        ended.set()

    ahead = FitsAhead(problem)
    ahead.foresee({"likely": fit})
    assert started.wait(PATIENCE_S)
    ahead.foresee({})
    given_up.set()
    assert ended.wait(PATIENCE_S)
    assert raised
    assert ahead.done("likely", lambda problem: "made now") == "made now"
