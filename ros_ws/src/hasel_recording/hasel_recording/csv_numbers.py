"""The cells of a CSV recording as numbers in SI units."""

import math

import numpy as np

from hasel_recording.csv_columns import Column
from hasel_recording.csv_text import CsvText
from hasel_recording.errors import RecordingError

NOT_MEASURED = {"", "nan", "na", "n/a", "null", "none", "-"}


class CsvNumbers:
    """Columns of a file as arrays [rows]; raises RecordingError with the line of a cell that is no number."""

    def __init__(self, text: CsvText) -> None:
        self._text = text

    def column(self, column: Column, may_be_missing: bool = False) -> np.ndarray:
        """The column's numbers in its SI unit; a blank or NaN cell is NaN where it may be missing."""
        index = self._text.names.index(column.name)
        try:
            values = np.array([float(row[index]) for row in self._text.cells])
        except ValueError:  # a blank, a decimal comma, or what is no number at all
            values = np.array([np.nan])
        if not np.isfinite(values).all():
            values = np.array(
                [
                    self._number(row[index], column.name, line, may_be_missing)
                    for line, row in zip(self._text.lines, self._text.cells, strict=True)
                ]
            )
        return values * column.factor if column.factor != 1 else values

    def _number(self, cell: str, name: str, line: int, may_be_missing: bool) -> float:
        if may_be_missing and cell.lower() in NOT_MEASURED:
            return math.nan
        try:
            value = float(cell.replace(",", ".") if "." not in cell else cell)
        except ValueError:
            found = repr(cell) if cell else "a blank cell"
            raise RecordingError(
                f"{self._text.path}, line {line}: {found} in column {name} is not a number; repair or remove the line."
            ) from None
        if not math.isfinite(value):
            raise RecordingError(
                f"{self._text.path}, line {line}: {name} is {cell}, but a number is expected; "
                "repair or remove the line."
            )
        return value

    def times(self, column: Column) -> np.ndarray:
        """The time column [s], which must increase."""
        times = self.column(column)
        late = np.flatnonzero(np.diff(times) <= 0)
        if late.size:
            row = late[0] + 1
            shown = [f"{time / column.factor:g}" for time in (times[row], times[row - 1])]
            raise RecordingError(
                f"{self._text.path}, line {self._text.lines[row]}: {column.name} {shown[0]} does not come after "
                f"{shown[1]}; sort the rows by time and remove doubles."
            )
        return times
