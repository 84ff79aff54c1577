"""The columns of a CSV recording."""

from hasel_recording.errors import RecordingError, nearest
from hasel_recording.recording import MARKER_NAMES

TIME = "time_s"
SIN_THETA = "sin_theta"
VOLTAGES = ("voltage_upper_v", "voltage_lower_v")


def marker_columns(unit: str) -> list[str]:
    """Return the six marker columns in `unit` ("m" or "px"): head_x_m, head_y_m, middle_x_m …"""
    return [f"{marker}_{axis}_{unit}" for marker in MARKER_NAMES for axis in "xy"]


KNOWN = (TIME, *VOLTAGES, SIN_THETA, *marker_columns("m"), *marker_columns("px"))


def check_columns(columns: list[str], source: str) -> None:
    """Raise RecordingError unless the columns make a recording; `source` says where they were found."""
    for column in columns:
        if columns.count(column) > 1:
            raise RecordingError(f"{source} has the column {column!r} twice: keep one of them.")
        known = nearest(column, KNOWN)
        if column not in KNOWN and known not in (None, *columns):
            raise RecordingError(
                f"{source} has a column {column!r} that is not known: did you mean {known!r}?"
            )
    groups = [[TIME], list(VOLTAGES), marker_columns("m"), marker_columns("px")]
    if not any(set(group) <= set(columns) for group in groups[2:]):
        groups.append([SIN_THETA])
    for group in groups:
        absent = [column for column in group if column not in columns]
        wanted = group[0] in (TIME, SIN_THETA) or len(absent) < len(group)
        if absent and wanted:
            raise RecordingError(
                f"{source} has no column {absent[0]!r}, only {', '.join(columns)}: "
                f"add it, or write time_s, the two voltages and sin_theta or the markers as in the README."
            )
