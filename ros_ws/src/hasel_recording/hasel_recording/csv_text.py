"""The text of a lab's CSV file: header lines, a row of column names, cells."""

import codecs
import csv
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from hasel_recording.errors import RecordingError

SEPARATORS = (";", "\t", ",")


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


def read_text(path: Path) -> CsvText:
    """Read and split a file; raises RecordingError for one that is no text or has no rows.

    Cells are separated by semicolons, tabs or commas, whichever the row of column names has, else by blanks.
    """
    text = _decoded(path)
    metadata: dict[str, str] = {}
    lines = text.splitlines()
    for number, line in enumerate(lines):
        stripped = line.strip()
        if stripped.startswith("#"):
            key, colon, value = stripped[1:].partition(":")
            if colon:
                metadata[key.strip()] = value.strip()
        elif stripped and not stripped.lower().startswith("sep="):  # a spreadsheet's own first line
            return _table(path, metadata, stripped, lines[number + 1 :], number + 2)
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
        return content.decode(
            "latin-1"
        )  # what older spreadsheets write; numbers and names are the same in it


def _table(path: Path, metadata: dict[str, str], top: str, rest: list[str], first_line: int) -> CsvText:
    separator = next((sign for sign in SEPARATORS if sign in top), " ")
    names = [name.strip() for name in next(_split([top], separator))]
    if all(_is_number(name) for name in names):
        raise RecordingError(
            f"{path} has numbers where a row of column names is expected: put one on top, such as "
            "time_s,voltage_upper_v,voltage_lower_v,sin_theta."
        )
    padding = separator * (len(names) - 1)  # a spreadsheet fills header lines up to the table's width
    if padding:
        metadata = {key: value.removesuffix(padding) for key, value in metadata.items()}
    lines, cells = [], []
    for line, row in enumerate(_split(rest, separator), start=first_line):
        if not any(cell.strip() for cell in row):
            continue
        if len(row) != len(names):
            raise RecordingError(
                f"{path}, line {line} has {len(row)} cells where the top row names {len(names)} columns: "
                "repair or remove the line."
            )
        lines.append(line)
        cells.append([cell.strip() for cell in row])
    if not cells:
        raise RecordingError(f"{path} has column names but no frames: was the recording stopped too early?")
    return CsvText(path, metadata, names, lines, cells, separator)


def _split(lines: list[str], separator: str) -> Iterator[list[str]]:
    """Cells of every line; a blank separates however often it is repeated."""
    return (line.split() for line in lines) if separator == " " else csv.reader(lines, delimiter=separator)


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True
