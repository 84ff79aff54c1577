# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The curves of one run as one array of 32-bit numbers, and the map of where the model fails in all of them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from hasel_sysid.comparison import RunComparison
from hasel_sysid.report.overlay import driven_stretches
from hasel_sysid.residual_analysis.residual_tests import BINS
from hasel_sysid.residual_analysis.run_series import RunSeries

from hasel_workbench.state import SessionState


@dataclass(frozen=True)
class Curves:
    """rows [3 or 4, n]: time [s], measured, simulated sin theta, and, where something is being tried, simulated by the
    step before; the measured one has each run's offset taken out, as it is with the model shown, and NaN where it was
    not measured. driven: begin [s], end [s] and channel of the drive's strokes.
    """

    run: str
    unseen: bool
    rows: np.ndarray
    driven: tuple[tuple[float, float, int], ...]
    error: float
    error_before: float | None

    def header(self) -> dict[str, Any]:
        """What the numbers are, as plain words and numbers."""
        names = ("time", "measured", "simulated", "before")[: len(self.rows)]
        return {
            "run": self.run,
            "unseen": self.unseen,
            "frames": self.rows.shape[1],
            "rows": list(names),
            "driven": [list(each) for each in self.driven],
            "error": self.error,
            "errorBefore": self.error_before,
        }


def curves(state: SessionState, run: str) -> Curves:
    """Of what is shown and, while something is being tried, of what it started from."""
    number = state.number_of(run)
    shown, experiment = state.shown, state.every[number]
    time, measured = experiment.run.time, experiment.sin_theta
    compared = shown.comparison.runs[number]
    series, error, error_before = compared.series, compared.mean_absolute_error, None
    rows = [time, measured - series.offset, shown.simulations[number].sin_theta]
    if state.trial is not None:
        other = state.current.comparison.runs[number]
        error_before = other.mean_absolute_error
        rows.append(state.current.simulations[number].sin_theta + other.series.offset - series.offset)
    driven: Sequence[tuple[float, float, int]] = ()
    if series.drive is not None:
        ends = float(time[0]), float(time[-1])
        driven = driven_stretches(*series.drive, *ends)
    unseen = number >= len(state.experiments)
    return Curves(run, unseen, np.array(rows, dtype=np.float32), tuple(driven), error, error_before)


@dataclass(frozen=True)
class MapRow:
    """One run: mean of measured minus simulated sin theta by phase, [bins], NaN in a bin without a frame."""

    run: str
    mean: np.ndarray


def failure_map(runs: Sequence[RunComparison]) -> list[MapRow]:
    """A row for every run that has a cycle."""
    profiles = ((run.name, run.analysis.profile) for run in runs)
    return [MapRow(name, profile.mean) for name, profile in profiles if profile is not None]


def stretch(series: RunSeries, cell: int) -> tuple[float, float]:
    """Begin and end [s] of a cell of the map, in the cycle in which its error is largest.

    A run without a cycle is one stretch.
    """
    first, last = float(series.time[0]), float(series.time[-1])
    if series.cycle is None:
        return first, last
    inside = (series.cycle.phase(series.time) * BINS).astype(int) == cell
    inside &= series.time >= series.cycle.start
    width = series.cycle.period / BINS
    if not inside.any():
        begin = series.cycle.start + cell * width
        return begin, min(begin + width, last)
    worst = series.time[inside][int(np.argmax(np.abs(series.residual[inside])))]
    begin = series.cycle.start + width * np.floor((worst - series.cycle.start) / width)
    return max(first, float(begin)), min(last, float(begin + width))
