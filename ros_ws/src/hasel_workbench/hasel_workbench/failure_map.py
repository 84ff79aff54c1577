"""Where the model fails: the residual by run and phase of the drive's cycle, and the stretch behind each cell."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from hasel_sysid.comparison import RunComparison
from hasel_sysid.residual_analysis.residual_tests import BINS
from hasel_sysid.residual_analysis.run_series import RunSeries


@dataclass(frozen=True)
class MapRow:
    """One run: mean of measured minus simulated sin theta by phase, [bins], NaN in a bin without a frame."""

    run: str
    unseen: bool
    error: float
    mean: np.ndarray


def failure_map(runs: Sequence[RunComparison]) -> list[MapRow]:
    """A row for every run that has a cycle."""
    return [
        MapRow(run.name, run.unseen, run.mean_absolute_error, run.analysis.profile.mean)
        for run in runs
        if run.analysis.profile is not None
    ]


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
