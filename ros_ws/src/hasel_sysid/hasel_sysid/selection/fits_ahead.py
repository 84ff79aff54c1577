"""Fits that are begun before they are asked for, where a single one would leave processes without work."""

from collections.abc import Callable, Hashable, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from typing import Generic, TypeVar

from hasel_sim.turns import Turn, Turns

from hasel_sysid.problem import Problem

Found = TypeVar("Found")
Fit = Callable[[Problem], Found]


class FitsAhead(Generic[Found]):
    """Fits of a problem: the steps of one wait for the longest of its runs; others use what it leaves idle.

    As many are made at once as there are processes; what is foreseen beyond those waits for its turn.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        self._turns = problem.pool if isinstance(problem.pool, Turns) else None
        self._threads = ThreadPoolExecutor(self._turns.workers) if self._turns else None
        self._begun: dict[Hashable, tuple[Future[Found], Turn]] = {}

    def foresee(self, likely: Mapping[Hashable, Fit[Found]]) -> None:
        """Begin these, the first ones first, where there are several processes; give up what else was begun."""
        if self._turns is None or self._threads is None:
            return
        for gone in self._begun.keys() - likely.keys():
            self._turns.give_up(self._begun.pop(gone)[1])
        for key, fit in likely.items():
            if key not in self._begun:
                turn = self._turns.foreseen()
                self._begun[key] = self._threads.submit(self._made, fit, self._turns, turn), turn

    def _made(self, fit: Fit[Found], turns: Turns, turn: Turn) -> Found:
        with turns.within(turn):
            return fit(self._problem)

    def done(self, key: Hashable, fit: Fit[Found]) -> Found:
        """The result of a fit: of the one that was begun, or of one that is made now."""
        begun = self._begun.pop(key, None)
        if begun is None or self._turns is None:
            return fit(self._problem)
        future, turn = begun
        self._turns.ask(turn)
        return future.result()
