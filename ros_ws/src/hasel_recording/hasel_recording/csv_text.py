# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The text of a lab's CSV file: header lines, a row of column names, cells."""

import codecs
import csv
import re
from dataclasses import dataclass
from pathlib import Path

from hasel_recording.errors import RecordingError, warn

TEXT_SUFFIXES = (".csv", ".tsv", ".txt", ".dat", ".lvm")
SEPARATORS = (";", "\t", ",")
END_OF_HEADER = "***End_of_Header***"  # LabVIEW's .lvm: rows of columns begin after the last one
MARKER_COLUMNS = "columns time_s, head_x_m, head_y_m, middle_x_m, middle_y_m, tail_x_m, tail_y_m"
EXPORTS = (
    (
        r"Format Version,",
        "Motive",
        f"keep the row of column names and the rows below, as {MARKER_COLUMNS} (Motive's ground plane is X and Z)",
    ),
    (
        r"scorer,",
        "DeepLabCut",
        f"write one row of column names instead of its three, {MARKER_COLUMNS.replace('_m', '_px')}, with "
        "time_s = frame number / frame rate",
    ),
    (
        r"NO_OF_FRAMES\t",
        "Qualisys",
        f"keep only the rows of numbers under {MARKER_COLUMNS.replace('_m', '_mm')}, with time_s = frame number / "
        "FREQUENCY (or export with the time column)",
    ),
)
"""Exports of other programs that have no single row of column names: how they begin, and what to do."""


@dataclass(frozen=True)
class CsvText:
    """metadata: `#key: value` lines; names: of the columns; cells: one list per row; lines: the rows' line numbers;
    separator: the sign between the cells.
    """

    path: Path
    metadata: dict[str, str]
    names: list[str]
    lines: list[int]
    cells: list[list[str]]
    separator: str

    def column(self, name: str) -> list[str]:
        """The cells of a column."""
        index = self.names.index(name)
        return [row[index] for row in self.cells]


def read_text(path: Path) -> CsvText:
    """Read and split a file; raises RecordingError for one that is no text or has no rows.

    Cells are separated by semicolons, tabs or commas, whichever the row of column names has, else by blanks. A column
    without a name is left out where it is blank, otherwise called by its number, such as #5. A row that repeats the one
    before is left out with a RecordingWarning.
    """
    lines = re.split(r"\r\n|\r|\n", _decoded(path))
    for begins, program, advice in EXPORTS:
        if re.match(begins, lines[0]):
            raise RecordingError(
                f"{path} is an export of {program}, which has no single row of column names: {advice}."
            )
    metadata: dict[str, str] = {}
    skipped = max((n for n, line in enumerate(lines) if line.startswith(END_OF_HEADER)), default=-1)
    for number, line in enumerate(lines[skipped + 1 :], start=skipped + 1):
        stripped = line.strip()
        if stripped.startswith("#"):
            key, colon, value = stripped[1:].partition(":")
            if colon:
                metadata[key.strip()] = value.strip()
        elif stripped.lower().startswith("sep="):  # a spreadsheet's own first line
            continue
        elif stripped.strip("".join(SEPARATORS)):
            top = line.removesuffix("Comment") if skipped >= 0 else line  # of which most rows have none
            return _table(path, metadata, top.strip(" "), lines[number + 1 :], number + 1)
    raise RecordingError(f"{path} is empty: give a file with a row of column names and a row per frame.")


def _decoded(path: Path) -> str:
    content = path.read_bytes()
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return content.decode("utf-16", errors="replace")  # a spreadsheet's "Unicode text"
    if b"\0" in content:
        raise RecordingError(f"{path} is not a text file: give a CSV or an MCAP recording.")
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError:
        return content.decode("cp1252", errors="replace")  # what older spreadsheets write


def _table(path: Path, metadata: dict[str, str], top: str, rest: list[str], top_line: int) -> CsvText:
    separator = next((sign for sign in SEPARATORS if sign in top), " ")
    names = _split(path, top, separator, top_line)
    if all(_is_number(name) for name in names):
        raise RecordingError(
            f"{path} has numbers where a row of column names is expected: put one on top, such as "
            "time_s,voltage_upper_v,voltage_lower_v,sin_theta."
        )
    padding = separator * (len(names) - 1)  # a spreadsheet fills header lines up to the table's width
    if padding:
        metadata = {key: value.removesuffix(padding) for key, value in metadata.items()}
    needed = max(n for n, name in enumerate(names, start=1) if name)
    lines: list[int] = []
    cells: list[list[str]] = []
    doubles = 0
    for line, text in enumerate(rest, start=top_line + 1):
        row = _split(path, text, separator, line)
        if not any(row):
            continue
        while len(row) > len(names) and not row[-1]:
            row.pop()
        if not needed <= len(row) <= len(names):
            raise RecordingError(
                f"{path}, line {line} has {len(row)} cells where the top row names {len(names)} columns: "
                "repair or remove the line."
            )
        row += [""] * (len(names) - len(row))
        if cells and row == cells[-1]:
            doubles += 1
            continue
        lines.append(line)
        cells.append(row)
    if not cells:
        raise RecordingError(f"{path} has column names but no frames: was the recording stopped too early?")
    if doubles:
        warn(f"{path}: {doubles} rows that repeat the one before were left out.")
    kept = [n for n, name in enumerate(names) if name or any(row[n] for row in cells)]
    if len(kept) < len(names):
        cells = [[row[n] for n in kept] for row in cells]
    return CsvText(path, metadata, [names[n] or f"#{n + 1}" for n in kept], lines, cells, separator)


def _split(path: Path, line: str, separator: str, number: int) -> list[str]:
    """Cells of a line; a blank separates however often it is repeated. Raises RecordingError for an open quote."""
    if separator == " ":
        return line.split()
    if '"' not in line:
        return [cell.strip() for cell in line.split(separator)]
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator, strict=True))]
    except csv.Error:
        raise RecordingError(
            f"{path}, line {number} has a quotation mark that is not closed in that line: repair or remove it."
        ) from None


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True
