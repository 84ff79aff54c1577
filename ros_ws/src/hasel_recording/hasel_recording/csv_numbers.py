# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The cells of a CSV recording as numbers in SI units, and clocks that wrap as times that increase."""

import math
import re
from collections.abc import Sequence
from datetime import datetime, timezone
from functools import cached_property
from itertools import product

import numpy as np

from hasel_recording.csv_columns import Column
from hasel_recording.csv_text import CsvText
from hasel_recording.errors import RecordingError, warn

COUNTERS = {2**16: "a counter of 16 bits", 2**31: "a counter of 31 bits", 2**32: "a counter of 32 bits"}
CLOCKS_S = {60.0: "a clock without minutes", 3600.0: "a clock without hours", 86400.0: "midnight"}
"""What wraps, in steps of the column's unit and in seconds."""
FEW_STEPS = 5.0
NOT_MEASURED = {"", "nan", "na", "n/a", "null", "none", "-"}
BLANKS, QUOTES = "[ \u00a0\u2009\u202f]", "['\u2019]"
POINT = r"\."
NOTATIONS = (("", POINT), ("", ","), (",", POINT), (POINT, ","), *product((BLANKS, QUOTES), (POINT, ",")))
"""How numbers are written: the sign between groups of three digits, and the decimal one."""
CLOCK = re.compile(r"(?:\d+:)?\d{1,2}:\d{2}(?:[.,]\d*)?")


def _grammar(group: str, point: str) -> re.Pattern[str]:
    digits = rf"(?:[1-9]\d{{0,2}}(?:{group}\d{{3}})+|\d+)" if group else r"\d+"
    return re.compile(rf"[+-]?(?:{digits}(?:{point}\d*)?|{point}\d+)(?:[eE][+-]?\d+)?")


GRAMMARS = {notation: _grammar(*notation) for notation in NOTATIONS}


class CsvNumbers:
    """Columns of a file as arrays [rows]; raises RecordingError with the line of a cell that is no number.

    A notation is one of the whole file; where none fits all its columns, each column has its own.
    """

    def __init__(self, text: CsvText) -> None:
        self._text = text

    def column(self, column: Column, may_be_missing: bool = False) -> np.ndarray:
        """The column's numbers in its SI unit; a blank or NaN cell is NaN where it may be missing."""
        cells = self._text.column(column.name)
        notation = self._notation(column.name, cells)
        values = np.array([_number(cell, notation) for cell in cells])
        for row in np.flatnonzero(~np.isfinite(values)):
            cell, where = cells[row], f"{self._text.path}, line {self._text.lines[row]}"
            if cell.lower() in NOT_MEASURED and may_be_missing:
                continue
            if cell.lower().lstrip("+-") in ("nan", "inf", "infinity"):
                raise RecordingError(
                    f"{where}: {column.name} is {cell}, but a number is expected; repair or remove the line."
                )
            found = repr(cell) if cell else "a blank cell"
            raise RecordingError(
                f"{where}: {found} in column {column.name} is not a number; repair or remove the line."
            )
        return values * column.factor if column.factor != 1 else values

    def times(self, column: Column) -> np.ndarray:
        """The time column [s], which must increase; a clock that wraps is counted on, with a RecordingWarning.

        Seconds, or a time of day, or date and time, as text.
        """
        read = _clock(self._text.column(column.name))
        if read is not None:
            return _counted_on(read, column.name, 1.0, self._text)
        return _counted_on(self.column(column), column.name, column.factor, self._text)

    @cached_property
    def _notations(self) -> list[tuple[str, str]]:
        """The notations that fit every column of numbers; points between groups only where some cell has a comma."""
        comma = any("," in cell for row in self._text.cells for cell in row)
        possible = [notation for notation in NOTATIONS if comma or "," not in notation]
        for cells in zip(*self._text.cells, strict=True):
            possible = _fitting(cells, possible) or possible
        return possible

    def _notation(self, name: str, cells: list[str]) -> tuple[str, str]:
        """The one notation in which a column is written; raises RecordingError where two give other numbers."""
        fit = _fitting(cells, self._notations) or _fitting(cells, NOTATIONS) or [NOTATIONS[0]]
        if len(fit) == 1:
            return fit[0]
        for cell in filter(re.compile(r"\d[^\deE+-]\d").search, cells):
            read = sorted({_number(cell, notation) for notation in fit})
            if len(read) == 1:
                continue
            if self._text.separator != "," and ("", ",") in fit:
                return "", ","  # a comma that does not separate cells is a decimal one
            raise RecordingError(
                f"{self._text.path}: {cell!r} in column {name} may be {read[0]:g} or {read[1]:g}: write its numbers "
                "without groups of digits, and with a decimal point."
            )
        return fit[0]


def _fitting(cells: Sequence[str], notations: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
    """The notations in which every measured cell is a number."""
    measured = [cell.replace("\u2212", "-") for cell in cells if cell.lower() not in NOT_MEASURED]
    return [each for each in notations if all(map(GRAMMARS[each].fullmatch, measured))]


def _number(cell: str, notation: tuple[str, str]) -> float:
    """The number of a cell; NaN where it is none."""
    group, point = notation
    cell = cell.replace("\u2212", "-")
    if not GRAMMARS[notation].fullmatch(cell):
        return math.nan
    if group:
        cell = re.sub(group, "", cell)
    return float(cell.replace(",", ".") if point == "," else cell)


def _clock(cells: list[str]) -> np.ndarray | None:
    """Times of day (12:30:05.25) or dates with times (ISO 8601) in seconds; None where cells are neither."""
    if all(CLOCK.fullmatch(cell) for cell in cells):
        parts = [[float(part.replace(",", ".")) for part in cell.split(":")] for cell in cells]
        return np.array([sum(part * 60**power for power, part in enumerate(reversed(row))) for row in parts])
    try:
        dates = [datetime.fromisoformat(cell.replace(",", ".")) for cell in cells if not cell.isdecimal()]
    except ValueError:
        return None
    if len(dates) < len(cells):
        return None
    return np.array([date.replace(tzinfo=date.tzinfo or timezone.utc).timestamp() for date in dates])


def _counted_on(times: np.ndarray, name: str, factor: float, text: CsvText) -> np.ndarray:
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
                warn(
                    f"{text.path}, line {text.lines[row]}: {name} starts again after {span:.10g} s ({what}); it is "
                    "counted on."
                )
                break
    late = np.flatnonzero(np.diff(times) <= 0)
    if late.size == 0:
        return times
    row = int(late[0]) + 1
    raise RecordingError(
        f"{text.path}, line {text.lines[row]}: {name} {times[row] / factor:.12g} does not come after "
        f"{times[row - 1] / factor:.12g}; {_advice(times, row, usual)}."
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
