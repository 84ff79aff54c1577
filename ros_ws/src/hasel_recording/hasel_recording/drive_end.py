"""A drive that ends before the run: rows at the end of a CSV file whose drive cells are all blank."""

import warnings
from dataclasses import replace

from hasel_recording.csv_columns import Columns
from hasel_recording.csv_numbers import NOT_MEASURED
from hasel_recording.csv_text import CsvText
from hasel_recording.errors import RecordingWarning


def until_drive_ends(text: CsvText, columns: Columns) -> CsvText:
    """Return the rows in which the drive is known; a RecordingWarning says how many after its end are left out."""
    places = [text.names.index(column.name) for column in columns.drive.values()]
    known = [
        number
        for number, row in enumerate(text.cells, start=1)
        if any(row[place].lower() not in NOT_MEASURED for place in places)
    ]
    left_out = len(text.cells) - known[-1] if known else 0
    if not left_out:
        return text
    warnings.warn(
        f"{text.path}: {left_out} frames after the drive's end were left out: what drove the body then is not known.",
        RecordingWarning,
        stacklevel=4,
    )
    return replace(text, lines=text.lines[:-left_out], cells=text.cells[:-left_out])
