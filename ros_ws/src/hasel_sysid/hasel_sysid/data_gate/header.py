"""Faults of the header lines: keys that are misspelt."""

from hasel_recording import Recording
from hasel_recording.errors import nearest

from hasel_sysid.data_gate.finding import Finding, warning

KNOWN_KEYS = {
    "model": "model to use where --model is not given",
    "initial_state": "rest (default) or static_equilibrium",
    "initial_load_factor": "times all loads that act in static_equilibrium (default 1)",
    "initial_time_s": "when the body is let go (default: first frame or switch)",
    "drive": "file of the drive, beside the recording",
    "volts_per_<unit>": "the voltage columns stand for another quantity, such as volts_per_mbar: 10",
    "voltage_v": "voltage that was asked for, compared with the column",
    "frequency_hz": "frequency that was asked for, compared with the column",
    "muscles": "both, lower_first, upper or lower: which were meant to be driven",
}
"""Header keys that mean something, and what."""


def check_header(recording: Recording) -> list[Finding]:
    """Keys that resemble a known one; any other key is kept as a note."""
    found = []
    for key in recording.metadata:
        near = nearest(key, KNOWN_KEYS, similarity=0.85)
        if key not in KNOWN_KEYS and near and not key.startswith("volts_per_"):
            evidence = f"the header has '{key}', which is not known"
            found.append(warning("misspelt header", 1.0, evidence, f"did you mean '{near}'?"))
    return found
