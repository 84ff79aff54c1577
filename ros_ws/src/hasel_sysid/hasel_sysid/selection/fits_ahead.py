"""Fits that are begun before they are asked for, where a single one would leave processes without work."""

from collections.abc import Callable, Hashable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from threading import Event
from typing import Generic, TypeVar

from hasel_sim.errors import SimulationError
from hasel_sim.model import Model

from hasel_sysid.problem import Evaluation, Problem

Found = TypeVar("Found")
Fit = Callable[[Problem], Found]


class UnaskedError(Exception):
    """Ends a fit that nobody will ask for."""


class Interruptible(Problem):
    """A problem that is given up as soon as nobody wants to know any more."""

    def __init__(self, of: Problem, unwanted: Event) -> None:
        super().__init__(of.experiments, of.pool, of.measured_noise, of.time_limit)
        self._of, self._unwanted = of, unwanted

    def evaluate_each(
        self, models: Sequence[Model], names: Sequence[Sequence[str]]
    ) -> list[Evaluation | SimulationError]:
        """As of the problem itself; raises UnaskedError once it is unwanted."""
        if self._unwanted.is_set():
            raise UnaskedError
        return self._of.evaluate_each(models, names)


class FitsAhead(Generic[Found]):
    """Fits of a problem: the steps of one wait for the longest of its runs; several fill all processes.

    As many are made at once as there are processes; what is foreseen beyond those waits for its turn.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem = problem
        most = getattr(problem.pool, "workers", 1)
        self._threads = ThreadPoolExecutor(most) if most > 1 else None
        self._begun: dict[Hashable, tuple[Future[Found], Event]] = {}

    def foresee(self, likely: Mapping[Hashable, Fit[Found]]) -> None:
        """Begin these, the first ones first, where there are several processes; give up what else was begun."""
        if self._threads is None:
            return
        for gone in self._begun.keys() - likely.keys():
            self._begun.pop(gone)[1].set()
        for key in likely:
            if key not in self._begun:
                unwanted = Event()
                problem = Interruptible(self._problem, unwanted)
                self._begun[key] = self._threads.submit(likely[key], problem), unwanted

    def done(self, key: Hashable, fit: Fit[Found]) -> Found:
        """The result of a fit: of the one that was begun, or of one that is made now."""
        begun = self._begun.pop(key, None)
        return fit(self._problem) if begun is None else begun[0].result()
