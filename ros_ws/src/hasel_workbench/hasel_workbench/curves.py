"""The curves of one run as one array of 32-bit numbers, row by row."""

from dataclasses import dataclass

import numpy as np
from hasel_sysid.report.overlay import driven_stretches

from hasel_workbench.state import SessionState
from hasel_workbench.step import Step


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

    def header(self) -> dict:
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
    shown, before = state.shown, state.current if state.trial else None
    experiment = state.every[number]
    time, measured = experiment.run.time, experiment.sin_theta
    offset, error = _offset(shown, number)
    rows = [time, measured - offset, shown.simulations[number].sin_theta]
    error_before = None
    if before is not None:
        other, error_before = _offset(before, number)
        rows.append(before.simulations[number].sin_theta + other - offset)
    series = shown.comparison.runs[number].series
    driven = (
        ()
        if series.drive_time is None
        else driven_stretches(series.drive_time, series.drive_values, float(time[0]), float(time[-1]))
    )
    unseen = number >= len(state.experiments)
    return Curves(run, unseen, np.array(rows, dtype=np.float32), tuple(driven), error, error_before)


def _offset(step: Step, number: int) -> tuple[float, float]:
    run = step.comparison.runs[number]
    return run.series.offset, run.mean_absolute_error
