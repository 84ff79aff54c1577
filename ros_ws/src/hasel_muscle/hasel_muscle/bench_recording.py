# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What a bench recorded of one muscle, and its CSV file: time_s, voltage_v, contraction_mm, load_n, current_ma."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
from hasel_common.names import nearest
from hasel_recording.csv_columns import TIME_UNITS, Column, own_column, unit_at_the_end
from hasel_recording.csv_numbers import CsvNumbers
from hasel_recording.csv_text import CsvText, read_text
from hasel_recording.drive_channel import UNITS
from hasel_recording.errors import RecordingError

Held = Literal["load", "contraction"]


@dataclass(frozen=True)
class BenchRecording:
    """Samples at times [s] [n]: voltage [V], contraction [m], load [N] and, where measured, current [A], all [n].

    held: what the bench keeps, a hanging load or the contraction (a clamped length); the other one is the answer.
    contraction and load may be NaN where a sensor saw nothing.
    """

    name: str
    time: np.ndarray
    voltage: np.ndarray
    contraction: np.ndarray
    load: np.ndarray
    current: np.ndarray | None = None
    held: Held = "load"

    @property
    def answer(self) -> np.ndarray:
        """What the muscle does: contraction [m] under a load, load [N] at a held contraction."""
        return self.contraction if self.held == "load" else self.load


QUANTITIES = {
    "time": TIME_UNITS,
    "voltage": UNITS["voltage"],
    "contraction": UNITS["travel"],
    "load": {**UNITS["force"], "kg": 9.80665, "g": 9.80665e-3},
    "current": {**UNITS["current"], "ua": 1e-6},
}
"""Columns of a bench and, per unit that each may end in, its size in the SI unit; a mass counts as its weight."""


def read_bench_csv(path: Path, mapping: Mapping[str, str] | None = None) -> BenchRecording:
    """Read one recording; a load that never changes may stand in the header, as `#load_n: 0.59`, and so does what the
    bench keeps, as `#held: contraction` (else it is the load, a hanging weight).

    mapping: {name that is known here: the file's own column}, as of hasel_recording.csv_columns.parse_map.
    Raises RecordingError that names the column or line of what is wrong.
    """
    text = read_text(path)
    columns = _columns(text, _meant(text, mapping or {}))
    numbers = CsvNumbers(text)
    for name in ("time", "voltage", "contraction"):
        if name not in columns:
            raise RecordingError(
                f"{path} has no column {name}_<unit>, only {', '.join(text.names)}; expected {_example(name)}: rename "
                f"a column, or say which it is with --map {name}=COLUMN."
            )
    held = text.metadata.get("held", "load")
    if held not in ("load", "contraction"):
        said = f"#held is {held!r}, load or contraction was expected: correct that line."
        raise RecordingError(f"{path}: {said}")
    time = numbers.times(columns["time"])
    load = numbers.column(columns["load"], True) if "load" in columns else _constant_load(text, len(time))
    return BenchRecording(
        name=path.stem,
        time=time - time[0],
        voltage=numbers.column(columns["voltage"]),
        contraction=numbers.column(columns["contraction"], may_be_missing=True),
        load=load,
        current=numbers.column(columns["current"], True) if "current" in columns else None,
        held="load" if held == "load" else "contraction",
    )


def _meant(text: CsvText, mapping: Mapping[str, str]) -> dict[str, str]:
    """{the file's column: what it is read as, unit included}; a unit that is not given is that of the column's name."""
    found = {}
    for name, given in mapping.items():
        column = own_column(name, given, text.names, str(text.path))
        quantity = name if name in QUANTITIES else _parsed(name)[0]
        if quantity not in QUANTITIES:
            near = nearest(quantity, QUANTITIES)
            hint = f"did you mean {near!r}?" if near else f"expected one of {', '.join(QUANTITIES)}."
            raise RecordingError(f"--map gives {name}={column}, but nothing is called {name!r} here: {hint}")
        units = QUANTITIES[quantity]
        unit = _parsed(name)[1] if name != quantity else unit_at_the_end(column, units) or next(iter(units))
        found[column] = f"{quantity}_{unit}"
    return found


def _columns(text: CsvText, meant: Mapping[str, str]) -> dict[str, Column]:
    found: dict[str, Column] = {}
    for name in text.names:
        quantity, unit = _parsed(meant.get(name, name))
        if quantity not in QUANTITIES:
            if near := nearest(quantity, QUANTITIES):
                said = f"column {name!r} is not known; did you mean {_example(near)}?"
                raise RecordingError(f"{text.path}: {said}")
            continue
        if unit not in QUANTITIES[quantity]:
            units = ", ".join(QUANTITIES[quantity])
            raise RecordingError(
                f"{text.path}: column {name!r} has no unit that is known, expected {quantity}_ and one of {units}: "
                "rename it."
            )
        if quantity in found:
            raise RecordingError(f"{text.path} has two columns of {quantity}: keep one of them.")
        found[quantity] = Column(name, QUANTITIES[quantity][unit])
    return found


def _parsed(name: str) -> tuple[str, str]:
    quantity, _, unit = name.lower().rpartition("_")
    return (quantity, unit) if quantity else (unit, "")


def _example(quantity: str) -> str:
    return f"{quantity}_{next(iter(QUANTITIES[quantity]))}"


def _constant_load(text: CsvText, count: int) -> np.ndarray:
    for key, value in text.metadata.items():
        quantity, unit = _parsed(key)
        if quantity == "load" and unit in QUANTITIES["load"]:
            try:
                return np.full(count, float(value) * QUANTITIES["load"][unit])
            except ValueError:
                said = f"#{key} is {value!r}; expected a number: correct that line."
                raise RecordingError(f"{text.path}: {said}") from None
    raise RecordingError(
        f"{text.path} says no load, neither as a column load_n nor in its header as #load_n; expected one: add it "
        "(0 for a muscle that hangs free)."
    )
