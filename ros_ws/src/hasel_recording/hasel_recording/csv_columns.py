"""What the columns of a CSV recording mean."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from hasel_common.names import nearest

from hasel_recording.drive_channel import DriveChannel, is_drive_column, parse_column
from hasel_recording.errors import RecordingError
from hasel_recording.recording import MARKER_NAMES

SIN_THETA = "sin_theta"
TIME_UNITS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9, "min": 60.0}
THETA_UNITS = {"deg": 0.017453292519943295, "rad": 1.0, "mrad": 1e-3}
MARKER_UNITS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "px": 1.0}
MEANINGS = "time, sin_theta, theta, <marker>_x, <marker>_y or <quantity>_<channel>, such as voltage_upper"

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

    def names(self) -> set[str]:
        """The columns that are read."""
        single = [column for column in (self.time, self.sin_theta, self.theta) if column]
        return {column.name for column in (*single, *self.drive.values(), *self.markers)}


def marker_columns(names: Iterable[str], unit: str) -> list[str]:
    """Return the columns of markers in `unit` ("m" or "px"): head_x_m, head_y_m, middle_x_m …"""
    return [f"{marker}_{axis}_{unit}" for marker in names for axis in "xy"]


def understand(names: list[str], meant: Mapping[str, str], source: str, angle: bool = True) -> Columns:
    """Return what the columns mean.

    names: as in the file; meant: for some of them what to read them as (see column_map); source: where they were
    found; angle: whether an angle or markers must be there. Raises RecordingError for what is missing, twice,
    misspelt or in a unit that is not known.
    """
    reader = _Reader(names, meant, source, angle)
    columns = reader.columns()
    for name in columns.names():
        if names.count(name) > 1:
            raise RecordingError(f"{source} has the column {name!r} twice: keep one of them.")
    found = columns.sin_theta or columns.theta or set(MARKER_NAMES) <= set(columns.marker_names)
    if angle and not found:
        raise reader.missing(SIN_THETA, "or theta_deg, theta_rad, or the markers head, middle and tail")
    return columns


class _Reader:
    """Sorts columns by what they are; a column that is mapped counts before one that has the name itself."""

    def __init__(self, names: list[str], meant: Mapping[str, str], source: str, angle: bool) -> None:
        self.source, self.names, self.meant, self.angle = source, names, meant, angle
        self.left = {meant[name]: name for name in names if name in meant}
        mapped = {_role(name) for name in self.left}
        self.unused = [name for name in names if name not in meant and _role(name.lower()) in mapped]
        self.left |= {name.lower(): name for name in names if name not in (*meant, *self.unused)}

    def columns(self) -> Columns:
        """Take what is known and complain about what resembles it."""
        time = self._one("time", TIME_UNITS) or self._missing_time()
        sin_theta = Column(self.left.pop(SIN_THETA)) if SIN_THETA in self.left else None
        theta = None if sin_theta else self._one("theta", THETA_UNITS)
        names, markers, unit = self._markers()
        drive = self._drive(angle_known=bool(sin_theta or theta or markers))
        self._check_spelling()
        unused = tuple(sorted([*self.left.values(), *self.unused], key=self.names.index))
        return Columns(time, sin_theta, theta, drive, names, markers, unit, unused)

    def missing(self, name: str, others: str) -> RecordingError:
        """Return the error that says a column is missing and which there are."""
        return RecordingError(
            f"{self.source} has no column {name!r} ({others}), only {', '.join(self.names)}: "
            f"rename a column, or say which it is with --map {'' if self.angle else 'drive.'}{name}=COLUMN."
        )

    def _missing_time(self) -> Column:
        self._check_spelling()
        raise self.missing("time_s", "or time_ms, time_us, time_ns, time_min")

    def _one(self, quantity: str, units: Mapping[str, float]) -> Column | None:
        for unit, factor in units.items():
            if f"{quantity}_{unit}" in self.left:
                return Column(self.left.pop(f"{quantity}_{unit}"), factor)
        return None

    def _drive(self, angle_known: bool) -> dict[DriveChannel, Column]:
        found: dict[DriveChannel, Column] = {}
        nameless: list[RecordingError] = []
        for name in [name for name in self.left if is_drive_column(name)]:
            try:
                channel, factor = parse_column(name)
            except RecordingError as error:
                if name.count("_") > 1:
                    raise RecordingError(f"{self.source}: {error}") from None
                nameless.append(self._nameless(name, error))
                continue
            if channel in found:
                raise RecordingError(
                    f"{self.source} has {channel} twice, as {found[channel].name!r} and {name!r}: keep one of them."
                )
            found[channel] = Column(self.left.pop(name), factor)
        if nameless and not (found and angle_known):
            raise nameless[0]
        return found

    def _nameless(self, name: str, error: RecordingError) -> RecordingError:
        quantity, _, unit = name.lower().partition("_")
        if quantity == "angle" and unit in THETA_UNITS:
            return RecordingError(
                f"{self.source}: is {name!r} the bending angle? Then call it theta_{unit}, or give "
                f"--map theta_{unit}={self.left[name]}; an angle that drives is angle_<channel>_{unit}."
            )
        return RecordingError(f"{self.source}: {error}")

    def _markers(self) -> tuple[tuple[str, ...], tuple[Column, ...], str]:
        """Markers in metres, or else in pixels; those of the other unit are left over."""
        matches = {name: match for name in self.left if (match := _MARKER.fullmatch(name))}
        for in_pixels in (False, True):
            chosen = {n: m for n, m in matches.items() if (m["unit"] == "px") == in_pixels}
            if not chosen:
                continue
            markers = tuple(dict.fromkeys(match["marker"] for match in chosen.values()))
            columns = []
            for marker in markers:
                for axis in "xy":
                    columns.append(self._coordinate(marker, axis, chosen))
            return markers, tuple(columns), "px" if in_pixels else "m"
        return (), (), "m"

    def _coordinate(self, marker: str, axis: str, chosen: Mapping[str, re.Match]) -> Column:
        for name, match in chosen.items():
            if (match["marker"], match["axis"]) == (marker, axis):
                return Column(self.left.pop(name), MARKER_UNITS[match["unit"]])
        unit = next(match["unit"] for match in chosen.values() if match["marker"] == marker)
        raise self.missing(f"{marker}_{axis}_{unit}", "a marker has both coordinates in one unit")

    def _check_spelling(self) -> None:
        known = [SIN_THETA, *marker_columns(MARKER_NAMES, "m"), *marker_columns(MARKER_NAMES, "px")]
        known += [
            f"{q}_{unit}" for q, units in (("time", TIME_UNITS), ("theta", THETA_UNITS)) for unit in units
        ]
        known += ["voltage_upper_v", "voltage_lower_v"]
        for name, own in self.left.items():
            near = nearest(name, known)
            if own in self.meant and not (name in known or _MARKER.fullmatch(name) or is_drive_column(name)):
                hint = f"did you mean {near!r}?" if near else f"expected {MEANINGS}."
                raise RecordingError(f"--map gives {name}={own}, but nothing is called {name!r} here: {hint}")
            if near not in (None, *self.names) and name not in known:
                raise RecordingError(
                    f"{self.source} has a column {name!r} that is not known: did you mean {near!r}?"
                )


def _role(name: str) -> str:
    """What a column is for, whatever its unit: two columns of one role cannot both be read."""
    if name == SIN_THETA or name.startswith("theta_"):
        return SIN_THETA
    return name.rpartition("_")[0] if _MARKER.fullmatch(name) or is_drive_column(name) else name.split("_")[0]
