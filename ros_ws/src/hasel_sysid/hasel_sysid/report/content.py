# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a report can hold; every section is left out when it is empty."""

import platform
import shlex
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from datetime import datetime
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from hasel_sysid.comparison import Comparison
from hasel_sysid.report.shape import Shapes

if TYPE_CHECKING:
    from hasel_sysid.selection.choose import ComparedModel


_GIVEN: ContextVar[tuple[str, ...] | None] = ContextVar("given", default=None)
_PACKAGES = ("hasel_sysid", "hasel_sim", "hasel_recording", "numpy", "scipy", "numba")


@dataclass(frozen=True)
class Provenance:
    """command: that makes this again; versions: by package, Python's first; date: local, to the minute."""

    command: str
    versions: tuple[tuple[str, str], ...]
    date: str


def provenance() -> Provenance:
    """Of this process, now."""
    versions = [("Python", platform.python_version())]
    for name in _PACKAGES:
        try:
            versions.append((name, version(name)))
        except PackageNotFoundError:
            continue
    return Provenance(_command(), tuple(versions), datetime.now().astimezone().strftime("%Y-%m-%d %H:%M %Z"))


@contextmanager
def called_as(*words: str) -> Iterator[None]:
    """Within it, reports say this command: of a command that is called by another program and not typed."""
    token = _GIVEN.set(tuple(words))
    try:
        yield
    finally:
        _GIVEN.reset(token)


def _command() -> str:
    """As it was typed, `ros2 run` before an installed executable of a package."""
    given = _GIVEN.get()
    if given is not None:
        return shlex.join(["ros2", "run", *given])
    program, arguments = Path(sys.argv[0]), sys.argv[1:]
    installed = program.parent.parent.name == "lib" and program.parent.name.startswith("hasel_")
    called = ["ros2", "run", program.parent.name, program.name] if installed else [program.name]
    return shlex.join([*called, *arguments])


@dataclass(frozen=True)
class KeyNumber:
    """A number on top of the report: value as it shall be read, label under it, note in small print."""

    value: str
    label: str
    note: str = ""


@dataclass(frozen=True)
class RunOverlay:
    """One run: time [s] [n], measured sin theta [n], simulated sin theta [n] by what the model is called;
    drive: its level with the unit, empty for a passive body; driven: begin [s], end [s] and channel of its strokes.
    """

    name: str
    time: np.ndarray
    measured: np.ndarray
    simulated: dict[str, np.ndarray]
    unseen: bool = False
    drive: str = ""
    frequency: float = 0.0
    driven: Sequence[tuple[float, float, int]] = ()


@dataclass(frozen=True)
class StageRow:
    """Mean |Δ sin θ| of one stage on fitted and on unseen runs (None without such runs), and what was changed."""

    label: str
    error: float | None
    error_unseen: float | None = None
    note: str = ""


def known_errors(stages: Sequence[StageRow]) -> dict[str, list[tuple[str, float]]]:
    """Label and error of the stages of which it is known, on fitted and, where there are any, on unseen runs."""
    errors = {
        "fitted runs": [(stage.label, stage.error) for stage in stages],
        "unseen runs": [(stage.label, stage.error_unseen) for stage in stages],
    }
    known = {
        name: [(label, error) for label, error in rows if error is not None] for name, rows in errors.items()
    }
    return {name: rows for name, rows in known.items() if rows}


@dataclass(frozen=True)
class ParameterRow:
    """A parameter in its SI unit; remark: an alarm such as "at its upper bound", empty when all is well.

    meaning: in words; plausible: range that data sheets and literature give, with its source; before: its value before
    what the report is about, None where it was not there.
    """

    name: str
    value: float
    standard_error: float | None
    unit: str
    remark: str = ""
    meaning: str = ""
    plausible: str = ""
    before: float | None = None


@dataclass(frozen=True)
class RankedRow:
    """One effect of the ranking; shares and probability from 0 to 1; expected: its values; NaN where not known."""

    effect: str
    verdict: str
    probability: float
    error_removed: float
    expected: Sequence[ParameterRow] = ()
    swallowed: float = float("nan")
    physics: str = ""
    sentence: str = ""


@dataclass(frozen=True)
class NextRun:
    """A proposed experiment: what to do, and how far the remaining candidates differ in it, in units of the noise."""

    sentence: str
    difference_in_noise: float | None = None
    separates: Sequence[str] = ()


@dataclass(frozen=True)
class ReportContent:
    """All that one report shows.

    title, subtitle: of the page; verdict: the one sentence; good: whether that sentence is good news (None: neither);
    first_of_all: what must be known before any number is read; runs: measured against simulated; comparisons: error
    table and where the models fail; detailed: number of the one that is shown in detail (-1: the last);
    shapes: the body as it swings; stages with noise_floor [sin theta]: the error waterfall; ranking and groups: what is
    missing; models: all that were fitted; remains: sentences; recordings: their files; made: command, versions and
    date.
    """

    title: str
    subtitle: str = ""
    verdict: str = ""
    good: bool | None = None
    key_numbers: Sequence[KeyNumber] = ()
    runs: Sequence[RunOverlay] = ()
    comparisons: Sequence[Comparison] = ()
    detailed: int = 0
    shapes: Shapes | None = None
    stages: Sequence[StageRow] = ()
    noise_floor: float | None = None
    ranking: Sequence[RankedRow] = ()
    groups: Sequence[Sequence[str]] = ()
    models: "Sequence[ComparedModel]" = ()
    parameters: Sequence[ParameterRow] = ()
    remains: Sequence[str] = ()
    next_runs: Sequence[NextRun] = ()
    messages: Sequence[str] = field(default_factory=tuple)
    first_of_all: Sequence[str] = ()
    recordings: Sequence[str] = ()
    made: Provenance | None = None

    @property
    def detail(self) -> Comparison:
        """The comparison that is shown in detail."""
        return self.comparisons[self.detailed]
