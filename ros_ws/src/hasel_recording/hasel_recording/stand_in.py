"""Voltages that stand for another quantity, as the header line `volts_per_mbar: 10` says."""

import math
from collections.abc import Mapping

import numpy as np

from hasel_recording.drive_channel import SI_UNITS, UNITS, DriveChannel
from hasel_recording.errors import RecordingError

PREFIX = "volts_per_"


def as_meant(
    channels: tuple[DriveChannel, ...], values: np.ndarray, metadata: Mapping[str, str], source: str
) -> tuple[tuple[DriveChannel, ...], np.ndarray, str]:
    """Return the channels, their values [n, channels] and a sentence (empty where nothing stands for anything).

    The name of a channel stays; only voltages are converted. Raises RecordingError for a unit or number that is
    not understood.
    """
    keys = [key for key in metadata if key.lower().startswith(PREFIX)]
    if not keys or all(channel.quantity != "voltage" for channel in channels):
        return channels, values, ""
    if len(keys) > 1:
        raise RecordingError(f"{source} has the header lines {' and '.join(keys)}: keep one of them.")
    quantity, unit_size = _unit(keys[0], source)
    volts = _volts(metadata[keys[0]], keys[0], source)
    meant = tuple(
        DriveChannel(channel.name, quantity, SI_UNITS[quantity]) if channel.quantity == "voltage" else channel
        for channel in channels
    )
    scale = [unit_size / volts if channel.quantity == "voltage" else 1.0 for channel in channels]
    unit = keys[0][len(PREFIX) :]
    return meant, values * scale, f"{volts:g} V stand for 1 {unit} of {quantity} ({keys[0]} in the header)"


def _unit(key: str, source: str) -> tuple[str, float]:
    unit = key[len(PREFIX) :].lower()
    for quantity, units in UNITS.items():
        if unit in units:
            return quantity, units[unit]
    known = ", ".join(unit for units in UNITS.values() for unit in units)
    raise RecordingError(f"{source}: the header line {key!r} ends in no unit of {known}: correct it.")


def _volts(text: str, key: str, source: str) -> float:
    try:
        volts = float(text.replace(",", "."))
    except ValueError:
        volts = math.nan
    if not (math.isfinite(volts) and volts != 0):
        raise RecordingError(
            f"{source}: the header line {key!r} is {text!r}, expected a number of volts other than 0: correct it."
        )
    return volts
