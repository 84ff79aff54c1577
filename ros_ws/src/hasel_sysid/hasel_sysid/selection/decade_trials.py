"""Sizes over the decades of every range: a glimpse of all that no trial foretells, and trials of what is near."""

from collections.abc import Callable, Iterator, Sequence

import numpy as np
from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.candidates import Start, decade_starts
from hasel_sysid.diagnosis.glimpse import Glimpse, worth_a_trial
from hasel_sysid.diagnosis.trial import Trial, Trials
from hasel_sysid.estimation.opening import is_small


class Decades:
    """Sizes of one effect around a trial that was made.

    From it the first order leads to any other size. How far it errs at an end, where the residual is known, tells how
    far between: with the square of the way, unless it errs by much of the motion, for then it has stopped growing.
    Where that is little beside what is left, a size promises nothing new.
    """

    def __init__(
        self, effect: Effect, made: Sequence[Trial], unexplained: np.ndarray, motion: np.ndarray
    ) -> None:
        """made: trials of any effects; unexplained: residual of the model without the effect, motion: what was
        measured [frames].
        """
        own = [trial for trial in made if trial.start.effect.id == effect.id]
        beside = max(own, key=lambda trial: trial.promised).start if own else None
        known = [trial.start.values for trial in own]
        self.starts = [start for start in decade_starts(effect, beside) if start.values not in known]
        sizes = [p for p in effect.parameters if not p.scan]
        self.size = f"{effect.id}.{sizes[0].name}" if sizes else ""
        self._null, self._alone = (sizes[0].null if sizes else 0.0), len(sizes) == 1
        self._unexplained, self._motion = unexplained, motion
        self._known = next((t for t in own if self.starts and self._is_at(t, self.starts[0])), None)

    def _is_at(self, trial: Trial, start: Start) -> bool:
        """Whether all values but the size are those of a start."""
        own = trial.start.values
        return own.keys() == start.values.keys() and all(
            own[name] == value for name, value in start.values.items() if name != self.size
        )

    def ends(self) -> list[Start]:
        """The farthest sizes on either side of the known trial, but not towards the null; all where none is known."""
        if self._known is None:
            return self.starts
        here = self._known.start.values[self.size]
        ways = {start.values[self.size] - here: start for start in self.starts}
        farthest = {min(0.0, *ways), max(0.0, *ways)} - {0.0}
        return [ways[way] for way in sorted(farthest) if way * (self._null - here) <= 0]

    def between(self, ends: Sequence[Glimpse]) -> Iterator[Start]:
        """Sizes that are not foretold once the ends were seen; ends: of any effects, less what could not run.

        Without its only size an effect leaves what is unexplained.
        """
        tried = self.ends()
        reached = [(seen.start.values[self.size], seen.residual) for seen in ends if seen.start in tried]
        if self._alone:
            reached.append((self._null, self._unexplained))
        for start in self.starts:
            if start not in tried and not any(self._foretold(start, *end) for end in reached):
                yield start

    def _foretold(self, start: Start, end: float, residual: np.ndarray) -> bool:
        """Whether the first order of the known trial is true at a start, by its error at an end beyond it [frames]."""
        known = self._known
        if known is None or end == known.start.values[self.size]:
            return False
        way = end - known.start.values[self.size]
        share = (start.values[self.size] - known.start.values[self.size]) / way
        slope = known.jacobian[:, known.names.index(self.size)]
        error = residual - (known.residual - slope * way)
        between = 0.0 < share <= 1.0
        return between and is_small(error, self._motion) and is_small(share**2 * error, self._unexplained)


def decade_trials(
    trials: Trials,
    effects: Sequence[Effect],
    made: Sequence[Trial],
    glimpsed: Callable[[Sequence[Start]], list[Glimpse]],
    tried: Callable[[Sequence[Start]], list[Trial]],
) -> list[Trial]:
    """Trials over the decades of the effects' ranges; made: those at typical sizes or without effect.

    glimpsed, tried: see, or make trials of, many starts, as long as there is time.
    """
    left, motion = trials.fitted.residual, trials.fitted.measured()
    every = [Decades(effect, made, left, motion) for effect in effects]
    ends = glimpsed([start for decades in every for start in decades.ends()])
    seen = ends + glimpsed([start for decades in every for start in decades.between(ends)])
    return tried(worth_a_trial(seen, made, trials))
