# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""All that a session of the workbench knows, never changed, only replaced as a whole; and how its error fell."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from hasel_sysid.answer.diagnosis import Diagnosis
from hasel_sysid.answer.next_run import Suggestion
from hasel_sysid.errors import SysidError
from hasel_sysid.experiment import Experiment
from hasel_sysid.report.content import StageRow

from hasel_workbench.step import Step


@dataclass(frozen=True)
class Banner:
    """A sentence that must be seen before any number; severity: error or warning; about: the place of a recording."""

    severity: str
    text: str
    about: str = ""


@dataclass(frozen=True)
class Unread:
    """A file of rows that could not be read, and the names of its columns; unseen: what it is to be loaded as; said:
    why it could not be read with the columns that were named, empty before any was.
    """

    path: Path
    names: tuple[str, ...]
    unseen: bool = False
    said: str = ""


@dataclass(frozen=True)
class SessionState:
    """experiments, unseen: the runs; banners: what is wrong with recordings; steps: the history; at: the current one
    (those after it were taken back); trial: what is being tried and not yet kept; diagnosis: of the step
    numbered `diagnosed`; suggestions: runs to make next, the best first; unread: files whose columns are to be named.
    """

    experiments: tuple[Experiment, ...] = ()
    unseen: tuple[Experiment, ...] = ()
    banners: tuple[Banner, ...] = ()
    steps: tuple[Step, ...] = ()
    at: int = 0
    trial: Step | None = None
    diagnosis: Diagnosis | None = None
    diagnosed: int = 0
    suggestions: tuple[Suggestion, ...] = ()
    unread: tuple[Unread, ...] = ()

    @property
    def every(self) -> tuple[Experiment, ...]:
        """All runs, the unseen ones last."""
        return (*self.experiments, *self.unseen)

    @property
    def current(self) -> Step:
        """The last step that was kept. Raises SysidError before any run was loaded."""
        if not self.steps:
            raise SysidError("no run was loaded so far; expected at least one: drop .csv or .mcap files")
        return self.steps[self.at]

    @property
    def shown(self) -> Step:
        """What is being tried, else the current step."""
        return self.trial or self.current

    @property
    def kept(self) -> tuple[Step, ...]:
        """The history up to the current step."""
        return self.steps[: self.at + 1]

    def number_of(self, run: str) -> int:
        """Number of a run among all of them. Raises SysidError for one that is not there."""
        names = [each.name for each in self.every]
        if run not in names:
            known = ", ".join(names) or "none is loaded"
            raise SysidError(f"there is no run '{run}'; expected one of: {known}")
        return names.index(run)

    def with_banners(self, said: Sequence[Banner]) -> "SessionState":
        """With more banners; none is there twice."""
        return replace(self, banners=tuple(dict.fromkeys((*self.banners, *said))))

    def without_word_of(self, places: Collection[str]) -> "SessionState":
        """Without the banners about these recordings."""
        return replace(self, banners=tuple(each for each in self.banners if each.about not in places))

    def with_step(self, step: Step) -> "SessionState":
        """With one more step in the history, after the current one."""
        steps = (*self.kept, step) if self.steps else (step,)
        return replace(self, steps=steps, at=len(steps) - 1, trial=None)


_RMS_TO_MEAN = 0.798
"""Mean magnitude of Gaussian noise of unit standard deviation."""


@dataclass(frozen=True)
class Waterfall:
    """stages: of all steps up to the current one, and of what is being tried, if anything is; noise_floor: mean |noise|
    of sin theta, by the last diagnosis, else by the fastest part of the measured angle.
    """

    stages: tuple[StageRow, ...]
    tried: bool
    noise_floor: float


def waterfall(state: SessionState) -> Waterfall:
    """Of a session with at least one step."""
    steps = [*state.kept, *([state.trial] if state.trial else [])]
    stages = tuple(StageRow(step.label, step.error, step.error_unseen, step.file) for step in steps)
    return Waterfall(stages, state.trial is not None, noise_floor(state))


def noise_floor(state: SessionState) -> float:
    """Mean magnitude of the noise of sin theta, as far as it is known."""
    if state.diagnosis is not None:
        return state.diagnosis.measured.mean_absolute
    return _RMS_TO_MEAN * state.shown.comparison.where.noise
