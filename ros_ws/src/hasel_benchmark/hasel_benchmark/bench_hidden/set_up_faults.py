"""Faults of the set-up that are put into a case: the truth is driven, or seen, otherwise than the recording says."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from hasel_sim.run import Run

_LATE_S, _EARLY_S = 0.15, -0.05
"""By how much clocks differ: more than a supply or a camera is late, and less than nothing."""


@dataclass(frozen=True)
class SetUpFaultHidden:
    """everywhere: in all runs, or in one; drives: the run that the truth makes of a command; sign: of the angle;
    said: words that name it, either of them; effect: of the catalogue that is this fault, if there is one.
    """

    everywhere: bool
    drives: Callable[[Run], Run]
    said: tuple[str, ...]
    sign: float = 1.0
    effect: str = ""

    def runs(self, fitted: Sequence[str], every: Sequence[str], generator: np.random.Generator) -> set[str]:
        """The names of the runs that have it: of every one, or of one that is fitted."""
        return set(every) if self.everywhere else {fitted[int(generator.integers(len(fitted)))]}


def _as_it_is(run: Run) -> Run:
    return run


def _dead(channel: int) -> Callable[[Run], Run]:
    def drives(run: Run) -> Run:
        signal = run.schedule.signal.copy()
        signal[:, channel] = 0.0
        return replace(run, schedule=replace(run.schedule, signal=signal))

    return drives


def _exchanged(run: Run) -> Run:
    return replace(run, schedule=replace(run.schedule, signal=run.schedule.signal[:, ::-1]))


def _late(lag_s: float) -> Callable[[Run], Run]:
    """The camera's clock is ahead: what the body does is seen later than it was commanded."""

    def drives(run: Run) -> Run:
        return replace(run, schedule=replace(run.schedule, time=run.schedule.time + lag_s))

    return drives


_OPPOSITE = ("wrong sign", "exchanged")
FAULTS = {
    "dead_upper_channel": SetUpFaultHidden(False, _dead(0), ("upper channel is dead",)),
    "dead_lower_channel": SetUpFaultHidden(True, _dead(1), ("lower channel is dead",)),
    "exchanged_channels": SetUpFaultHidden(False, _exchanged, _OPPOSITE),
    "inverted_angle": SetUpFaultHidden(True, _as_it_is, _OPPOSITE, sign=-1.0),
    "late_clock": SetUpFaultHidden(False, _late(_LATE_S), ("clock of the angle is off",)),
    "early_clock": SetUpFaultHidden(True, _late(_EARLY_S), (), effect="camera_latency"),
}
"""What is hidden, by name."""
