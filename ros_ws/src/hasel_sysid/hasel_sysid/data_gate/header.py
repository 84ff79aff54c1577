"""Faults of the header lines: values that are not understood, keys that are misspelt."""

from hasel_common.names import nearest
from hasel_recording import Recording
from hasel_recording.recording import KNOWN_KEYS

from hasel_sysid.data_gate.finding import DataFinding, error, warning


def check_header(recording: Recording) -> list[DataFinding]:
    """Values that are not understood, and keys that resemble a known one; any other key is kept as a note."""
    found = [*_numbers(recording)]
    for key in recording.metadata:
        near = nearest(key, KNOWN_KEYS, similarity=0.85)
        if key not in KNOWN_KEYS and near and not key.startswith("volts_per_"):
            evidence = f"the header has '{key}', which is not known"
            found.append(warning("misspelt header", 1.0, evidence, f"did you mean '{near}'?"))
    return found


def _numbers(recording: Recording) -> list[DataFinding]:
    found = []
    for key in ("initial_time_s", "initial_load_factor"):
        try:
            value = float(recording.metadata.get(key, "0"))
        except ValueError:
            evidence = f"{key} is '{recording.metadata[key]}', expected a number"
            found.append(error("header value", 1.0, evidence, "correct the header line"))
            continue
        if key == "initial_time_s" and key in recording.metadata and value > recording.time_s[-1]:
            evidence = (
                f"the body is let go at {value:g} s and the last frame is at {recording.time_s[-1]:g} s"
            )
            found.append(error("header value", value, evidence, "correct initial_time_s"))
    return found
