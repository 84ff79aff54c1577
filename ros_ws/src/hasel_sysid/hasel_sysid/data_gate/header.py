"""Faults of the header lines: keys that are misspelt."""

from hasel_recording import Recording
from hasel_recording.errors import nearest
from hasel_recording.header_keys import KNOWN_KEYS

from hasel_sysid.data_gate.finding import Finding, warning


def check_header(recording: Recording) -> list[Finding]:
    """Keys that resemble a known one; any other key is kept as a note."""
    found = []
    for key in recording.metadata:
        near = nearest(key, KNOWN_KEYS, similarity=0.85)
        if key not in KNOWN_KEYS and near and not key.startswith("volts_per_"):
            evidence = f"the header has '{key}', which is not known"
            found.append(warning("misspelt header", 1.0, evidence, f"did you mean '{near}'?"))
    return found
