# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What the columns of a CSV recording mean: by their own names and units, or by `--map time=t,sin_theta=angle_deg`."""

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product

from hasel_common.names import nearest

from hasel_recording.drive_channel import (
    HASEL_PAIR,
    RAD_PER_DEG,
    SI_UNITS,
    UNITS,
    DriveChannel,
    is_drive_column,
    parse_column,
)
from hasel_recording.errors import RecordingError
from hasel_recording.recording import MARKER_NAMES

SIN_THETA = "sin_theta"
DRIVE_ONLY = "drive."  # before a name that is meant for the file of the drive alone
TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0}
THETA_UNITS = {"deg": RAD_PER_DEG, "rad": 1.0, "mrad": 1e-3}
MARKER_UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "px": 1.0}
MEANINGS = "time, sin_theta, theta, <marker>_x, <marker>_y or <quantity>_<channel>, such as voltage_upper"

TIMES = {f"time_{unit}": factor for unit, factor in TIME_UNITS.items()}
THETAS = {f"theta_{unit}": factor for unit, factor in THETA_UNITS.items()}
_MARKER = re.compile(r"(?P<marker>.+)_(?P<axis>[xy])_(?P<unit>" + "|".join(MARKER_UNITS) + ")")


@dataclass(frozen=True)
class Column:
    """A column that is used. name: in the file; factor: its unit in the SI unit."""

    name: str
    factor: float = 1.0


@dataclass(frozen=True)
class Columns:
    """What is read from where.

    sin_theta, theta: the angle's column, at most one of them; drive: one column per channel; marker_names and markers:
    x and y of every marker in turn, in marker_unit after scaling; unused: columns that mean nothing here.
    """

    time: Column
    sin_theta: Column | None
    theta: Column | None
    drive: dict[DriveChannel, Column]
    marker_names: tuple[str, ...]
    markers: tuple[Column, ...]
    marker_unit: str
    unused: tuple[str, ...]


def marker_columns(names: Iterable[str], unit: str) -> list[str]:
    """Return the columns of markers in `unit` ("m" or "px"): head_x_m, head_y_m, middle_x_m …"""
    return [f"{marker}_{axis}_{unit}" for marker in names for axis in "xy"]


def understand(names: list[str], meant: Mapping[str, str], source: str, angle: bool = True) -> Columns:
    """Return what the columns mean; one that is mapped counts before one that has the name itself.

    names: as in the file; meant: for some of them what to read them as (see meant_names); source: where they were
    found; angle: whether an angle or markers must be there. Raises RecordingError for what is missing, twice,
    misspelt or in a unit that is not known.
    """

    def missing(name: str, others: str) -> RecordingError:
        _check_spelling(left, names, meant, source)
        return RecordingError(
            f"{source} has no column {name!r} ({others}), only {', '.join(names)}: "
            f"rename a column, or say which it is with --map {'' if angle else 'drive.'}{name}=COLUMN."
        )

    left = {meant[name]: name for name in names if name in meant}
    mapped = {_role(name) for name in left}
    left |= {name.lower(): name for name in names if name not in meant and _role(name.lower()) not in mapped}
    time, sin_theta = _first(left, TIMES), _first(left, {SIN_THETA: 1.0})
    if time is None:
        raise missing("time_s", f"or {', '.join([*TIMES][1:])}")
    theta = None if sin_theta else _first(left, THETAS)
    markers, unit = _markers(left)
    drive = _drive(left, source, needed=not (sin_theta or theta or markers))
    _check_spelling(left, names, meant, source)
    marker_names = tuple(dict.fromkeys(marker for marker, _ in markers))
    for marker, axis in product(marker_names, "xy"):
        if (marker, axis) not in markers:
            factor = next(column.factor for (name, _), column in markers.items() if name == marker)
            own = unit if factor == 1 else next(u for u, each in MARKER_UNITS.items() if each == factor)
            raise missing(f"{marker}_{axis}_{own}", "a marker has both coordinates in one unit")
    if angle and not (sin_theta or theta or set(MARKER_NAMES) <= set(marker_names)):
        raise missing(SIN_THETA, "or theta_deg, theta_rad, or the markers head, middle and tail")
    in_order = tuple(markers[place] for place in product(marker_names, "xy"))
    read = [column.name for column in (time, sin_theta, theta, *drive.values(), *in_order) if column]
    for name in read:
        if names.count(name) > 1:
            raise RecordingError(f"{source} has the column {name!r} twice: keep one of them.")
    unused = tuple(name for name in names if name not in read)
    return Columns(time, sin_theta, theta, drive, marker_names, in_order, unit, unused)


def _first(left: dict[str, str], known: Mapping[str, float]) -> Column | None:
    """The first of the known columns that the file has; known: name → its unit in the SI unit."""
    name = next((name for name in known if name in left), None)
    return None if name is None else Column(left.pop(name), known[name])


def _markers(left: dict[str, str]) -> tuple[dict[tuple[str, str], Column], str]:
    """Coordinates by marker and axis and their unit: those in metres, where there are none those in pixels."""
    matches = [match for name in left if (match := _MARKER.fullmatch(name))]
    unit = "px" if matches and all(match["unit"] == "px" for match in matches) else "m"
    found: dict[tuple[str, str], Column] = {}
    for match in matches:
        place = match["marker"], match["axis"]
        if (match["unit"] == "px") == (unit == "px") and place not in found:
            found[place] = Column(left.pop(match[0]), MARKER_UNITS[match["unit"]])
    return found, unit


def _drive(left: dict[str, str], source: str, needed: bool) -> dict[DriveChannel, Column]:
    """The channels; one without a name is left over where others are there and nothing is missing without it."""
    found: dict[DriveChannel, Column] = {}
    nameless = None
    for name in filter(is_drive_column, list(left)):
        try:
            channel, factor = parse_column(name)
        except RecordingError as error:
            quantity, *rest = name.split("_")
            said = str(error)
            if quantity == "angle" and len(rest) == 1 and rest[0] in THETA_UNITS:
                said = (
                    f"is {name!r} the bending angle? Then call it theta_{rest[0]}, or give "
                    f"--map theta_{rest[0]}={left[name]}; an angle that drives is angle_<channel>_{rest[0]}."
                )
            nameless = nameless or RecordingError(f"{source}: {said}")
            if len(rest) > 1:
                raise RecordingError(f"{source}: {said}") from None
            continue
        if channel in found:
            raise RecordingError(
                f"{source} has {channel} twice, as {found[channel].name!r} and {left[name]!r}: keep one of them."
            )
        found[channel] = Column(left.pop(name), factor)
    if nameless and (needed or not found):
        raise nameless
    return found


def _check_spelling(left: Mapping[str, str], names: list[str], meant: Mapping[str, str], source: str) -> None:
    """Raise RecordingError where what is left resembles a name that is known."""
    markers = [*marker_columns(MARKER_NAMES, "m"), *marker_columns(MARKER_NAMES, "px")]
    known = [SIN_THETA, *markers, *TIMES, *THETAS, *(channel.column for channel in HASEL_PAIR)]
    for name, own in left.items():
        near = nearest(name, known)
        if own in meant and not (name in known or _MARKER.fullmatch(name) or is_drive_column(name)):
            hint = f"did you mean {near!r}?" if near else f"expected {MEANINGS}."
            raise RecordingError(f"--map gives {name}={own}, but nothing is called {name!r} here: {hint}")
        if near not in (None, *names) and name not in known:
            raise RecordingError(f"{source} has a column {name!r} that is not known: did you mean {near!r}?")


def _role(name: str) -> str:
    """What a column is for, whatever its unit: two columns of one role cannot both be read."""
    if name == SIN_THETA or name.startswith("theta_"):
        return SIN_THETA
    return name.rpartition("_")[0] if _MARKER.fullmatch(name) or is_drive_column(name) else name.split("_")[0]


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
    quantity, unit = (meant.lower().split("_")[end] for end in (0, -1))
    if meant == SIN_THETA:
        unit = unit_at_the_end(column, THETA_UNITS)
        return f"theta_{unit}" if unit else SIN_THETA
    if meant in ("theta", "time"):
        known, usual = (THETA_UNITS, "rad") if meant == "theta" else (TIME_UNITS, "s")
    elif re.fullmatch(r".+_[xy]", meant):
        known, usual = MARKER_UNITS, "m"
    elif is_drive_column(meant) and unit not in UNITS[quantity]:
        known, usual = UNITS[quantity], SI_UNITS[quantity].lower()
    else:
        return meant
    return f"{meant}_{unit_at_the_end(column, known) or usual}"


def unit_at_the_end(column: str, units: Iterable[str]) -> str | None:
    """The unit that a lab's own name ends in, of those that are known here."""
    words = re.findall(r"[a-z]+", column.lower().replace("°", "_deg").replace("µ", "u"))
    return words[-1] if len(words) > 1 and words[-1] in units else None
