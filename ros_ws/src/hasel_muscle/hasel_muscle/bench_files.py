# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Recordings of a bench from files and folders, and the muscle that they are of.

Beside CSV files, MATLAB 7.3 files as of the public repository MadhavL/PH-HASEL-Python. `data` has five columns:
time [s]; commanded voltage, 2 kV per volt; position, 4 mm per volt, growing as the muscle contracts; measured voltage,
2 kV per volt; measured current, 2 mA per volt. The name begins with the mass that hangs from the muscle, as in
`60g__step…`. Its `parameters.py` holds the muscle's dimensions as plain assignments.
"""

import ast
import contextlib
import re
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
from hasel_recording.errors import RecordingError, RecordingWarning
from hasel_sim.model.muscle_file import MuscleDescription, load_muscle, muscle_of
from hasel_sim.muscle.muscle import Muscle
from hasel_sysid.errors import SysidError

from hasel_muscle.bench_recording import BenchRecording, read_bench_csv
from hasel_muscle.settled import SettledRun, settled

_VOLTAGE, _POSITION, _CURRENT = 2000.0, 4e-3, 2e-3
"""Of a volt of the data logger [V, m, A]."""
_COLUMNS = 5
_SENSOR_VOLTS = 10.0
_BLIND = 0.02
"""Share of the position sensor's range at either end at which it sees nothing any more."""
_MASS = re.compile(r"(\d+(?:[.-]\d+)?)\s*g_", re.IGNORECASE)
_NEEDED = ("n_pouches", "w", "t", "eps_r", "Lp", "Le")
_DEFAULT = "peano_hasel"


def read_bench_mat(path: Path) -> BenchRecording:
    """Read one file; samples at which the position sensor was out of its range are NaN. Raises RecordingError."""
    time, commanded, position, _, current = _table(path).T
    mass = _MASS.match(path.name)
    if mass is None:
        raise RecordingError(
            f"{path.name} does not begin with the mass that hangs from the muscle, as 60g__ does: rename the file."
        )
    load = float(mass[1].replace("-", ".")) * 9.80665e-3
    dark = (position < _BLIND * _SENSOR_VOLTS) | (position > (1 - _BLIND) * _SENSOR_VOLTS)
    return BenchRecording(
        name=path.stem,
        time=time - time[0],
        voltage=_VOLTAGE * commanded,
        contraction=np.where(dark, np.nan, _POSITION * position),
        load=np.full(len(time), load),
        current=_CURRENT * current,
    )


def _table(path: Path) -> np.ndarray:
    try:
        import h5py
    except ImportError:
        raise RecordingError(
            f"{path}: h5py, which reads MATLAB 7.3 files, is not installed: pip install h5py, or export CSV."
        ) from None
    try:
        with h5py.File(path) as file:
            table = np.asarray(file["data"], dtype=float)
    except OSError:
        raise RecordingError(
            f"{path} is no MATLAB 7.3 file: export the samples as CSV, or save with -v7.3."
        ) from None
    except (KeyError, TypeError, ValueError):
        raise RecordingError(
            f"{path} holds no table of numbers called 'data': is it a recording of the bench?"
        ) from None
    table = table.T if table.ndim == 2 and table.shape[0] == _COLUMNS else table
    if table.ndim != 2 or table.shape[1] != _COLUMNS or len(table) < 2:
        raise RecordingError(
            f"{path} holds 'data' of the shape {table.shape}; expected {_COLUMNS} columns: time, commanded voltage, "
            "position, measured voltage, current."
        )
    if not np.isfinite(table[:, :2]).all() or np.any(np.diff(table[:, 0]) <= 0):
        raise RecordingError(
            f"{path}: its times do not increase, or a voltage is no number: repair or leave it out."
        )
    return table


def muscle_beside(path: Path) -> Muscle | None:
    """The muscle that a `parameters.py` in the file's folder or up to two above it describes; None where there is none.

    Nothing of that file is run. Raises RecordingError where a dimension is missing.
    """
    places = [folder / "parameters.py" for folder in (path.parent, *path.parent.parents)[:3]]
    source = next((place for place in places if place.is_file()), None)
    if source is None:
        return None
    try:
        known = _assignments(source.read_text(encoding="utf-8", errors="replace"))
    except SyntaxError as error:
        raise RecordingError(
            f"{source}, line {error.lineno}: not Python; expected assignments of numbers."
        ) from None
    missing = [name for name in _NEEDED if name not in known]
    if missing:
        raise RecordingError(
            f"{source} does not say {', '.join(missing)}; expected {', '.join(_NEEDED)}: add them."
        )
    count = round(known["n_pouches"])
    described = {
        "name": "muscle",
        "pouch": {
            "count": count,
            "film_length_m": known["Lp"] / count,
            "electrode_length_m": known["Le"] / count,
            "width_m": known["w"],
            "film_thickness_m": known["t"],
            "relative_permittivity": known["eps_r"],
        },
        "mass_kg": known.get("m_hasel", 0.0),
    }
    return muscle_of(MuscleDescription.model_validate(described))


def _assignments(text: str) -> dict[str, float]:
    """Names that are assigned a number, or products and quotients of numbers and such names."""
    found: dict[str, float] = {}
    for line in ast.parse(text).body:
        if isinstance(line, ast.Assign) and len(line.targets) == 1 and isinstance(line.targets[0], ast.Name):
            value = _number(line.value, found)
            if value is not None:
                found[line.targets[0].id] = value
    return found


def _number(node: ast.expr, known: dict[str, float]) -> float | None:
    if isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        return float(node.value)
    if isinstance(node, ast.Name):
        return known.get(node.id)
    if not isinstance(node, ast.BinOp) or not isinstance(node.op, ast.Mult | ast.Div):
        return None
    left, right = _number(node.left, known), _number(node.right, known)
    if left is None or right is None or (isinstance(node.op, ast.Div) and right == 0):
        return None
    return left * right if isinstance(node.op, ast.Mult) else left / right


def read_bench(path: Path, mapping: Mapping[str, str] | None = None) -> BenchRecording:
    """One recording, .csv or .mat; mapping: columns of a .csv, as of --map. Raises RecordingError."""
    if not path.is_file():
        raise RecordingError(f"there is no recording {path}: check the name.")
    if path.suffix.lower() not in (".csv", ".mat"):
        raise RecordingError(f"{path}: a bench recording is a .csv or .mat file, not '{path.suffix}'.")
    return read_bench_mat(path) if path.suffix.lower() == ".mat" else read_bench_csv(path, mapping)


def readable(paths: Sequence[Path], mapping: Mapping[str, str] | None = None) -> list[BenchRecording]:
    """Those of the recordings that can be read."""
    found = []
    for path in paths:
        with contextlib.suppress(RecordingError):
            found.append(read_bench(path, mapping))
    return found


def settled_runs(
    paths: Sequence[Path], settling: float, mapping: Mapping[str, str] | None = None
) -> list[SettledRun]:
    """The settled frames of all recordings; one that cannot be used is told of and left out.

    Raises SysidError where none is left.
    """
    found = []
    for path in paths:
        try:
            found.append(settled(read_bench(path, mapping), settling))
        except (RecordingError, SysidError) as error:
            if len(paths) == 1:
                raise
            warnings.warn(f"left out: {error}", RecordingWarning, stacklevel=2)
    if not found:
        raise SysidError(
            "no recording can be used, for the reasons given; expected at least one with held lifts"
        )
    return found


def muscle_for(name: str | None, paths: Sequence[Path]) -> Muscle:
    """The muscle that was asked for, or the one described beside the recordings, or the package's own."""
    if name is not None:
        return load_muscle(name)
    described = next((muscle for path in paths if (muscle := muscle_beside(path)) is not None), None)
    if described is not None:
        return described
    warnings.warn(
        f"no --muscle was given: the package's own, '{_DEFAULT}', is taken; describe yours in a muscle file",
        RecordingWarning,
        stacklevel=2,
    )
    return load_muscle(_DEFAULT)
