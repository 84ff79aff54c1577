"""Faults of the commanded voltage: unit, dead or doubled channel, clipping, irregular switching, a faked command."""

import numpy as np
from hasel_recording import Recording

from hasel_sysid.data_gate.finding import Finding, error, warning
from hasel_sysid.where_it_fails.drive_cycle import drive_cycle

_CHANNELS = ("upper", "lower")
_MOST_LIKELY_KILOVOLTS = 20.0
_FEW_LEVELS = 8


def check_command(recording: Recording) -> list[Finding]:
    """Faults of the voltage, by itself and against the header lines; none for a passive body."""
    if recording.voltage is None and recording.drive_time_s is None:
        return []
    time, voltage = recording.drive()
    if not np.all(np.isfinite(voltage)):
        lost = int(np.count_nonzero(~np.isfinite(voltage).all(axis=1)))
        return [error("lost command", lost, f"{lost} voltages are NaN", "record the supply's state")]
    if not voltage.any():
        evidence = "both voltages are 0 V all the time"
        return [warning("no command", 0.0, evidence, "arm the supply, or leave the voltage columns out")]
    return [
        *_unit(voltage),
        *_channels(recording, voltage),
        *_clipping(recording, voltage),
        *_switching(recording, time, voltage),
        *_faked(recording),
    ]


def _unit(voltage: np.ndarray) -> list[Finding]:
    largest = float(np.abs(voltage).max())
    if largest > _MOST_LIKELY_KILOVOLTS:
        return []
    evidence = f"the largest voltage is {largest:g} V"
    return [error("unit of the voltage", largest, evidence, "give volts; is it in kilovolts?")]


def _channels(recording: Recording, voltage: np.ndarray) -> list[Finding]:
    used = np.abs(voltage).max(axis=0) > 0
    both = recording.metadata.get("muscles", "both") in ("both", "lower_first")
    if used.all():
        if not np.array_equal(voltage[:, 0], voltage[:, 1]):
            return []
        evidence = "both muscles get the same voltage all the time"
        return [error("doubled channel", 1.0, evidence, "check which columns were recorded")]
    if not both:
        return []
    unused = _CHANNELS[int(np.argmin(used))]
    said = "muscles" in recording.metadata
    evidence = f"the {unused} muscle never gets a voltage"
    if said:
        return [error("dead channel", 0.0, f"{evidence}, the header says both", "check the supply's channel")]
    return [warning("dead channel", 0.0, evidence, f"check the {unused} channel unless this is meant")]


def _clipping(recording: Recording, voltage: np.ndarray) -> list[Finding]:
    magnitude = np.abs(voltage)
    largest = float(magnitude.max())
    found = []
    asked = _number(recording.metadata.get("voltage_v"))
    if asked is not None and largest < 0.99 * asked:
        evidence = f"the header asks for {asked:g} V and {largest:g} V are commanded at most"
        found.append(error("clipped command", largest, evidence, "raise the limit or ask for less"))
    own = magnitude.max(axis=0)
    if not found and own.min() > 0 and own.min() < 0.99 * own.max():
        lower = _CHANNELS[int(np.argmin(own))]
        evidence = f"the {lower} muscle gets {own.min():g} V, the other one {own.max():g} V"
        found.append(warning("clipped command", own.min(), evidence, "check the limits of both channels"))
    driven = magnitude[magnitude > 0]
    at_limit = float(np.mean(driven == largest))
    if not found and len(np.unique(driven)) >= _FEW_LEVELS and at_limit > 0.15:
        evidence = f"a waveform of many levels stays at {largest:g} V for {at_limit:.0%} of the time"
        found.append(warning("clipped command", at_limit, evidence, "raise the limit or ask for less"))
    return found


def _switching(recording: Recording, time: np.ndarray, voltage: np.ndarray) -> list[Finding]:
    cycle = drive_cycle(time, voltage)
    if cycle is None:
        evidence = "the drive never switches from one muscle to the other or off and on"
        return [warning("too little excitation", 1.0, evidence, "record at least one whole period")]
    frame = float(np.median(np.diff(recording.time_s)))
    distances = np.diff(cycle.switches)
    distances = distances[distances < 1.5 * np.median(distances)]
    spread = float(np.ptp(distances))
    if spread > max(1.6 * frame, 0.05 * float(np.median(distances))):
        evidence = f"switches are {distances.min() * 1e3:.0f} to {distances.max() * 1e3:.0f} ms apart"
        return [
            warning("shifted command", spread, evidence, "record what the supply did, not what was asked")
        ]
    asked = _number(recording.metadata.get("frequency_hz"))
    if asked and abs(1 / cycle.period / asked - 1) > 0.03 + frame / cycle.period:
        evidence = f"the header says {asked:g} Hz and the command switches at {1 / cycle.period:.3g} Hz"
        return [warning("shifted command", 1 / cycle.period, evidence, "correct the header or the clock")]
    return []


def _faked(recording: Recording) -> list[Finding]:
    if recording.voltage is None:
        return []
    valid = recording.valid
    command = (np.abs(recording.voltage[:, 0]) - np.abs(recording.voltage[:, 1]))[valid]
    measured = recording.sin_theta[valid]
    if len(measured) < 16 or np.ptp(command) == 0 or np.ptp(measured) == 0:
        return []
    alike = float(np.corrcoef(command, measured)[0, 1])
    if abs(alike) < 0.999:
        return []
    evidence = f"angle and command have a correlation of {alike:.4f}"
    return [
        error("command equals measurement", alike, evidence, "check which signal was recorded as the angle")
    ]


def _number(text: str | None) -> float | None:
    try:
        return None if text is None else float(text)
    except ValueError:
        return None
