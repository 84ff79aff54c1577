"""All checks of a recording that need no model."""

from dataclasses import replace

from hasel_recording import Recording

from hasel_sysid.data_gate.angle import check_angle
from hasel_sysid.data_gate.command import check_command
from hasel_sysid.data_gate.drive_frequency import check_drive_frequency
from hasel_sysid.data_gate.finding import DataFinding, Severity
from hasel_sysid.data_gate.frames import check_frames
from hasel_sysid.data_gate.header import check_header
from hasel_sysid.data_gate.markers import check_markers
from hasel_sysid.data_gate.response import check_response

_STOP = {"too few frames", "time order", "unit of time", "run of hours"}
_NO_RESPONSE = {"unit of the angle", "frozen angle", "command equals measurement", "lost command"}


def check_recording(recording: Recording) -> list[DataFinding]:
    """Faults of the set-up that the recording shows by itself, errors first."""
    found = [*check_header(recording), *check_frames(recording)]
    if not _STOP & {finding.fault for finding in found}:
        found += [*check_angle(recording), *check_command(recording), *check_markers(recording)]
        if not _NO_RESPONSE & {finding.fault for finding in found}:
            found += [*check_response(recording), *check_drive_frequency(recording)]
    return ordered(recording.name, found)


def refusal(recording: Recording) -> DataFinding | None:
    """The fault with which a recording cannot even be simulated; None where it can."""
    return next((f for f in ordered(recording.name, check_frames(recording)) if f.fault in _STOP), None)


def ordered(name: str, found: list[DataFinding]) -> list[DataFinding]:
    """The findings with the recording's name, errors first."""
    named = [replace(finding, recording=name) for finding in found]
    return sorted(named, key=lambda finding: finding.severity is not Severity.ERROR)
