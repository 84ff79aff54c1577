"""The cells of a CSV recording as numbers in SI units."""

import math
import re
from collections.abc import Sequence
from datetime import datetime, timezone
from functools import cached_property

import numpy as np

from hasel_recording.csv_clock import counted_on
from hasel_recording.csv_columns import Column
from hasel_recording.csv_text import CsvText
from hasel_recording.errors import RecordingError

NOT_MEASURED = {"", "nan", "na", "n/a", "null", "none", "-"}
BLANKS, APOSTROPHES = "[ \u00a0\u2009\u202f]", "['\u2019]"
NOTATIONS = (
    ("", r"\."),
    ("", ","),
    (",", r"\."),
    (r"\.", ","),
    (BLANKS, r"\."),
    (BLANKS, ","),
    (APOSTROPHES, r"\."),
    (APOSTROPHES, ","),
)
"""How numbers are written: the sign between groups of three digits, and the decimal one."""
CLOCK = re.compile(r"(?:\d+:)?\d{1,2}:\d{2}(?:[.,]\d*)?")


def _grammar(group: str, point: str) -> re.Pattern:
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
            self._check_missing(cells[row], column.name, int(row), may_be_missing)
        return values * column.factor if column.factor != 1 else values

    def times(self, column: Column) -> np.ndarray:
        """The time column [s], which must increase; a clock that wraps is counted on, with a RecordingWarning.

        Seconds, or a time of day, or date and time, as text.
        """
        cells = self._text.column(column.name)
        read = _clock(cells)
        times = self.column(column) if read is None else read
        return counted_on(times, column.name, 1.0 if read is not None else column.factor, self._text)

    def _check_missing(self, cell: str, name: str, row: int, may_be_missing: bool) -> None:
        if cell.lower() in NOT_MEASURED and may_be_missing:
            return
        where = f"{self._text.path}, line {self._text.lines[row]}"
        if cell.lower().lstrip("+-") in ("nan", "inf", "infinity"):
            raise RecordingError(
                f"{where}: {name} is {cell}, but a number is expected; repair or remove the line."
            )
        found = repr(cell) if cell else "a blank cell"
        raise RecordingError(f"{where}: {found} in column {name} is not a number; repair or remove the line.")

    @cached_property
    def _notations(self) -> list[tuple[str, str]]:
        """The notations that fit every column of numbers; points between groups only where some cell has a comma."""
        comma = any("," in cell for row in self._text.cells for cell in row)
        possible = [notation for notation in NOTATIONS if comma or "," not in notation]
        for cells in map(list, zip(*self._text.cells, strict=True)):
            fit = _fitting(cells, possible)
            possible = fit or possible
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


def _fitting(cells: list[str], notations: Sequence[tuple[str, str]]) -> list[tuple[str, str]]:
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
