"""Names and units of a lab's own columns, from an option such as `--map time=t,sin_theta=angle_deg`.

A column may have any name, also one with a comma, or is given by its number (`time=#1`); `drive.time=t` is meant for
the file of the drive only.
"""

import re
from collections.abc import Iterable, Mapping, Sequence

from hasel_common.names import nearest

from hasel_recording.csv_columns import MARKER_UNITS, SIN_THETA, THETA_UNITS, TIME_UNITS
from hasel_recording.drive_channel import SI_UNITS, UNITS, is_drive_column
from hasel_recording.errors import RecordingError

DRIVE_ONLY = "drive."


def parse_map(text: str) -> dict[str, str]:
    """Return {what is meant: the file's column} of `time=t,sin_theta=angle_deg`; raises RecordingError.

    A comma belongs to a column's name unless NAME= follows.
    """
    found: dict[str, str] = {}
    for part in filter(None, (part.strip() for part in re.split(r",(?=\s*[a-z][\w.]*\s*=)", text))):
        meant, equals, column = (piece.strip() for piece in part.partition("="))
        if not (equals and meant and column):
            raise RecordingError(
                f"{part!r} names no column, expected pairs such as time=t,sin_theta=angle_deg: write NAME=COLUMN."
            )
        if meant in found:
            raise RecordingError(f"{meant!r} is named twice: keep one of the columns.")
        found[meant] = column
    return found


def as_mapping(given: Mapping[str, str] | str | None) -> Mapping[str, str]:
    """What is meant, however it is given: as pairs in a text, as a mapping, or not at all; raises RecordingError."""
    if isinstance(given, str):
        return parse_map(given)
    names = {} if given is None else given
    if not isinstance(names, Mapping) or not all(
        isinstance(word, str) for pair in names.items() for word in pair
    ):
        raise RecordingError(
            f"found {given!r} for the names of columns: give pairs such as {{'time': 't', 'sin_theta': 'angle_deg'}}."
        )
    return names


def meant_names(
    mapping: Mapping[str, str],
    columns: Iterable[str],
    source: str,
    all_here: bool = True,
    of_drive: bool = False,
) -> dict[str, str]:
    """Return {the file's column: the full name it is read as}, units included.

    mapping: as of parse_map. A unit that is not given is taken from the end of the file's own name (`angle_deg`,
    `t [ms]`), else it is the SI unit. all_here: raise RecordingError for a column that the file has not got; otherwise
    the columns may be spread over two files. of_drive: the columns are those of a drive's own file, for which
    `drive.NAME` goes before NAME.
    """
    columns = list(columns)
    names: dict[str, str] = {}
    own = {meant.removeprefix(DRIVE_ONLY): c for meant, c in mapping.items() if meant.startswith(DRIVE_ONLY)}
    shared = {meant: c for meant, c in mapping.items() if not meant.startswith(DRIVE_ONLY)}
    for meant, column in (shared | own if of_drive else shared).items():
        if _found(column, columns) is None and not all_here and meant not in own:
            continue
        found = own_column(meant, column, columns, source)
        names[found] = _full_name(meant, found)
    return names


def own_column(meant: str, column: str, columns: Sequence[str], source: str) -> str:
    """The file's column of this name or number (#2); raises RecordingError where there is none."""
    found = _found(column, columns)
    if found is None:
        near = nearest(column, columns)
        hint = f"did you mean {near!r}?" if near else f"choose among {', '.join(columns)}."
        raise RecordingError(f"{source} has no column {column!r} for {meant}={column}: {hint}")
    return found


def _found(column: str, columns: Sequence[str]) -> str | None:
    if re.fullmatch(r"#\d+", column) and column not in columns and 0 < int(column[1:]) <= len(columns):
        return columns[int(column[1:]) - 1]
    return column if column in columns else None


def _full_name(meant: str, column: str) -> str:
    if meant == SIN_THETA:
        unit = unit_at_the_end(column, THETA_UNITS)
        return f"theta_{unit}" if unit else SIN_THETA
    if meant == "theta":
        return f"theta_{unit_at_the_end(column, THETA_UNITS) or 'rad'}"
    if meant == "time":
        return f"time_{unit_at_the_end(column, TIME_UNITS) or 's'}"
    if re.fullmatch(r".+_[xy]", meant):
        return f"{meant}_{unit_at_the_end(column, MARKER_UNITS) or 'm'}"
    if is_drive_column(meant):
        quantity = meant.lower().split("_")[0]
        if meant.lower().rsplit("_", 1)[-1] not in UNITS[quantity]:
            return f"{meant}_{unit_at_the_end(column, UNITS[quantity]) or SI_UNITS[quantity].lower()}"
    return meant


def unit_at_the_end(column: str, units: Iterable[str]) -> str | None:
    """The unit that a lab's own name ends in, of those that are known here."""
    words = re.findall(r"[a-z]+", column.lower().replace("°", "_deg").replace("µ", "u"))
    return words[-1] if len(words) > 1 and words[-1] in units else None
