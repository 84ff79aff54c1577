# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What drives a body: channels with a name, a quantity and a unit, as a CSV column names them."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from hasel_common.names import nearest

from hasel_recording.errors import RecordingError

PA_PER_PSI = 6894.757293168361
RAD_PER_DEG = 0.017453292519943295

UNITS: dict[str, dict[str, float]] = {
    "voltage": {"v": 1.0, "kv": 1e3, "mv": 1e-3},
    "pressure": {"pa": 1.0, "hpa": 1e2, "kpa": 1e3, "mpa": 1e6, "mbar": 1e2, "bar": 1e5, "psi": PA_PER_PSI},
    "travel": {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6},
    "angle": {"rad": 1.0, "mrad": 1e-3, "deg": RAD_PER_DEG},
    "current": {"a": 1.0, "ma": 1e-3},
    "force": {"n": 1.0, "mn": 1e-3, "kn": 1e3},
}
"""Quantities that can drive a body, and per unit that a column may end in its size in the SI unit."""

PREFIX = "volts_per_"
SI_UNITS = {"voltage": "V", "pressure": "Pa", "travel": "m", "angle": "rad", "current": "A", "force": "N"}


def _check_quantity(quantity: str, where: str) -> None:
    if quantity in UNITS:
        return
    near = nearest(quantity, UNITS)
    hint = f"did you mean {near}?" if near else "choose one of these."
    raise RecordingError(f"{where}: {quantity!r} drives no body, expected {', '.join(UNITS)}: {hint}")


@dataclass(frozen=True)
class DriveChannel:
    """One input of a body. name: such as upper; quantity: a key of UNITS; unit: the quantity's SI unit.

    Raises RecordingError for a quantity that is not known or a unit that is not its SI unit.
    """

    name: str
    quantity: str
    unit: str

    def __post_init__(self) -> None:
        _check_quantity(self.quantity, f"channel {self.name!r}")
        expected = SI_UNITS[self.quantity]
        if self.unit != expected:
            raise RecordingError(
                f"Channel {self.name!r} gives its {self.quantity} in {self.unit!r}, "
                f"but {expected} is expected: convert it."
            )

    @property
    def column(self) -> str:
        """The channel's column in a CSV recording, such as voltage_upper_v."""
        return f"{self.quantity}_{self.name}_{self.unit.lower()}"

    def shown(self, value: float) -> str:
        """Return a value of this channel with its unit, such as "25000 Pa"."""
        return f"{value:.6g} {self.unit}"

    def __str__(self) -> str:
        return f"{self.quantity} of {self.name} [{self.unit}]"


HASEL_PAIR = (DriveChannel("upper", "voltage", "V"), DriveChannel("lower", "voltage", "V"))
"""What the rig's supply drives; a message that names no muscles carries these two voltages in this order."""


def is_drive_column(column: str) -> bool:
    """Return whether a column's name begins with a quantity that can drive a body."""
    return column.lower().split("_")[0] in UNITS


def parse_column(column: str) -> tuple[DriveChannel, float]:
    """Return the channel of a column named <quantity>_<channel>_<unit> and the column's unit in the SI unit.

    Raises RecordingError for a quantity or unit that is not known, or where the channel's name is missing.
    """
    quantity, _, rest = column.lower().partition("_")
    _check_quantity(quantity, f"column {column!r}")
    name, _, unit = rest.rpartition("_")
    units = UNITS[quantity]
    if not name:
        example = f"{quantity}_main_{unit if unit in units else next(iter(units))}"
        raise RecordingError(
            f"{column}: a {quantity} without the name of its channel, expected "
            f"{quantity}_<channel>_<unit> such as {example}: rename the column, or map it with --map."
        )
    if unit not in units:
        raise RecordingError(
            f"{column}: {unit!r} is no unit of {quantity} that is known, expected {', '.join(units)}: "
            f"rename the column, for instance {quantity}_{name}_{next(iter(units))}."
        )
    return DriveChannel(name, quantity, SI_UNITS[quantity]), units[unit]


def as_meant(
    channels: tuple[DriveChannel, ...], values: np.ndarray, metadata: Mapping[str, str], source: str
) -> tuple[tuple[DriveChannel, ...], np.ndarray, str]:
    """Read voltages as what they stand for where a header line says so, such as `volts_per_mbar: 10`.

    Return the channels, their values [n, channels] and a sentence (empty where nothing stands for anything).

    The name of a channel stays; only voltages are converted. Raises RecordingError for a unit or number that is
    not understood.
    """
    keys = [key for key in metadata if key.lower().startswith(PREFIX)]
    if not keys or all(channel.quantity != "voltage" for channel in channels):
        return channels, values, ""
    if len(keys) > 1:
        raise RecordingError(f"{source} has the header lines {' and '.join(keys)}: keep one of them.")
    (key,) = keys
    unit = key[len(PREFIX) :]
    quantity = next((quantity for quantity, units in UNITS.items() if unit.lower() in units), None)
    if quantity is None:
        known = ", ".join(unit for units in UNITS.values() for unit in units)
        raise RecordingError(f"{source}: the header line {key!r} ends in no unit of {known}: correct it.")
    try:
        volts = float(metadata[key].replace(",", "."))
    except ValueError:
        volts = math.nan
    if not (math.isfinite(volts) and volts != 0):
        raise RecordingError(
            f"{source}: the header line {key!r} is {metadata[key]!r}, expected a number of volts other than 0: "
            "correct it."
        )
    meant = tuple(
        DriveChannel(channel.name, quantity, SI_UNITS[quantity]) if channel.quantity == "voltage" else channel
        for channel in channels
    )
    scale = [
        UNITS[quantity][unit.lower()] / volts if channel.quantity == "voltage" else 1.0
        for channel in channels
    ]
    return meant, values * scale, f"{volts:g} V stand for 1 {unit} of {quantity} ({key} in the header)"
