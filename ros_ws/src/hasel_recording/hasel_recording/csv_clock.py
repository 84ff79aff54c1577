"""Times of a CSV recording that do not increase: clocks that wrap, rows that share a time, rows out of order."""

import warnings

import numpy as np

from hasel_recording.csv_text import CsvText
from hasel_recording.errors import RecordingError, RecordingWarning

COUNTERS = {2**16: "a counter of 16 bits", 2**31: "a counter of 31 bits", 2**32: "a counter of 32 bits"}
CLOCKS_S = {60.0: "a clock without minutes", 3600.0: "a clock without hours", 86400.0: "midnight"}
"""What wraps, in steps of the column's unit and in seconds."""
FEW_STEPS = 5.0


def counted_on(times: np.ndarray, name: str, factor: float, text: CsvText) -> np.ndarray:
    """Times [s] [n] that increase: a clock that wraps is counted on, with a RecordingWarning.

    factor: the column's unit in s. Raises RecordingError with the line where rows share a time, the clock starts anew
    or rows are out of order.
    """
    steps = np.diff(times)
    if len(steps) == 0 or steps.min() > 0:
        return times
    usual = float(np.median(steps))
    wraps = {factor * count: what for count, what in COUNTERS.items()} | CLOCKS_S
    times = times.copy()
    for row in 1 + np.flatnonzero(steps < 0):
        back = float(times[row - 1] - times[row])
        for span, what in wraps.items():
            if -FEW_STEPS * usual < back - span < 1e-6 * span:
                times[row:] += span
                warnings.warn(
                    f"{text.path}, line {text.lines[row]}: {name} starts again after {span:.10g} s ({what}); it is "
                    "counted on.",
                    RecordingWarning,
                    stacklevel=5,
                )
                break
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size == 0:
        return times
    row = int(late[0]) + 1
    shown = [f"{time / factor:.12g}" for time in (times[row], times[row - 1])]
    raise RecordingError(
        f"{text.path}, line {text.lines[row]}: {name} {shown[0]} does not come after {shown[1]}; "
        f"{_advice(times, row, usual)}."
    )


def _advice(times: np.ndarray, row: int, usual: float) -> str:
    """What to do about the first row that does not come after the one before."""
    steps = np.diff(times)
    shared = int(np.count_nonzero(steps == 0))
    if times[row] == times[row - 1]:
        finest = float(steps[steps > 0].min(initial=np.inf))
        rounded = f", rounded to {finest:g} s" if np.isfinite(finest) and shared > 1 else ""
        return f"{shared} rows share the time of the one before{rounded}: write it with more digits"
    if np.count_nonzero(steps < 0) == 1 and times[row] <= times[0] + max(usual, 0.0):
        return "the clock starts anew there, as after a restart: make two recordings of it"
    return "sort the rows by time"
