"""Trials at sizes over the decades of every range, less those that another trial foretells."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.candidates import Start, decade_starts
from hasel_sysid.diagnosis.trial import Trial, Trials
from hasel_sysid.estimation.opening import is_small


class Decades:
    """Sizes of one effect around a trial that was made.

    From it the first order leads to any other size. How far it errs at an end, where the residual is known, tells how
    far between: with the square of the way. Where that is little beside what is left, a size promises nothing new.
    """

    def __init__(self, effect: Effect, made: Sequence[Trial], unexplained: np.ndarray) -> None:
        """made: trials of any effects; unexplained: residual of the model without the effect [frames]."""
        self.starts = [start for start in decade_starts(effect) if start not in [t.start for t in made]]
        self.size = next((f"{effect.id}.{p.name}" for p in effect.parameters if not p.scan), "")
        self._unexplained = unexplained
        self._null = {f"{effect.id}.{p.name}": p.null for p in effect.parameters if not p.scan}
        self._known = next((t for t in made if self.starts and self._is_at(t, self.starts[0])), None)

    def _is_at(self, trial: Trial, start: Start) -> bool:
        """Whether all values but the size are those of a start."""
        own = trial.start.values
        return own.keys() == start.values.keys() and all(
            own[name] == value for name, value in start.values.items() if name != self.size
        )

    def _way(self, start: Start) -> float:
        return start.values[self.size] - self._known.start.values[self.size] if self._known else 0.0

    def ends(self) -> list[Start]:
        """The farthest sizes on either side of the known trial, but not towards the null, whose residual is known."""
        if self._known is None:
            return self.starts
        to_null = self._null[self.size] - self._known.start.values[self.size]
        sides = ([s for s in self.starts if side * self._way(s) > 0] for side in (-1.0, 1.0))
        farthest = [max(some, key=lambda s: abs(self._way(s))) for some in sides if some]
        return [s for s in farthest if self._way(s) * to_null <= 0]

    def between(self, ends: Sequence[Trial]) -> Iterator[Start]:
        """Sizes that are not foretold once the ends were tried; ends: of any effects, less what could not run."""
        if self._known is None:
            return
        tried = self.ends()
        reached = [(self._way(t.start), t.residual) for t in ends if t.start in tried]
        if len(self._null) == 1:
            to_null = self._null[self.size] - self._known.start.values[self.size]
            reached += [(to_null, self._unexplained)] if to_null else []
        for start in self.starts:
            if start not in tried and not any(self._foretold(start, *end) for end in reached):
                yield start

    def _foretold(self, start: Start, way: float, residual: np.ndarray) -> bool:
        known = self._known
        share = self._way(start) / way
        if known is None or not 0.0 < share <= 1.0:
            return False
        slope = known.jacobian[:, known.names.index(self.size)]
        error = residual - (known.residual - slope * way)
        return is_small(share**2 * error, self._unexplained)


def decade_trials(
    trials: Trials,
    effects: Sequence[Effect],
    made: Sequence[Trial],
    tried: Callable[[Sequence[Start]], list[Trial]],
) -> list[Trial]:
    """Trials over the decades of the effects' ranges; made: those at typical sizes or without effect.

    tried: makes trials of many starts, as long as there is time.
    """
    every = [Decades(effect, made, trials.fitted.residual) for effect in effects]
    ends = tried([start for decades in every for start in decades.ends()])
    return ends + tried([start for decades in every for start in decades.between(ends)])
