"""Read recordings of the kind of the public repository MadhavL/PH-HASEL-Python: MATLAB 7.3 files of a muscle's bench.

`data` has five columns: time [s]; commanded voltage, 2 kV per volt; position, 4 mm per volt, growing as the muscle
contracts; measured voltage, 2 kV per volt; measured current, 2 mA per volt. The name begins with the mass that hangs
from the muscle, as in `60g__step…`. Its `parameters.py` holds the muscle's dimensions as plain assignments.
"""

import ast
import re
from pathlib import Path

import numpy as np
from hasel_recording.errors import RecordingError
from hasel_sim.model.muscle_file import MuscleDescription, muscle_of
from hasel_sim.muscle.muscle import Muscle

from hasel_muscle.recording import BenchRecording

_SCALES = {"voltage": 2000.0, "position": 4e-3, "current": 2e-3}
_COLUMNS = 5
_SENSOR_VOLTS = 10.0
_BLIND = 0.02
"""Share of the position sensor's range at either end at which it sees nothing any more."""
_MASS = re.compile(r"(\d+(?:[.-]\d+)?)\s*g_", re.IGNORECASE)
_NEEDED = ("n_pouches", "w", "t", "eps_r", "Lp", "Le")


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
        voltage=_SCALES["voltage"] * commanded,
        contraction=np.where(dark, np.nan, _SCALES["position"] * position),
        load=np.full(len(time), load),
        current=_SCALES["current"] * current,
        path=path,
        understood=(
            f"a load of {load:.3g} N, from the file's name",
            f"{dark.sum()} samples out of the sensor's range",
        ),
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
    if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult | ast.Div):
        left, right = _number(node.left, known), _number(node.right, known)
        if left is None or right is None or (isinstance(node.op, ast.Div) and right == 0):
            return None
        return left * right if isinstance(node.op, ast.Mult) else left / right
    return None
