"""Effects that are hidden in the truth and stand in no catalogue, one user's file each."""

from pathlib import Path

_CLASSES = {
    "cubic_drag": "CubicDrag",
    "electrode_leakage": "ElectrodeLeakage",
    "heavier_body": "HeavierBody",
    "one_sided_dead_zone": "OneSidedDeadZone",
    "stirred_bath": "StirredBath",
    "tired_by_strokes": "TiredByStrokes",
}
UNLISTED = {name: f"{Path(__file__).parent / name}.py:{kind}" for name, kind in _CLASSES.items()}
"""Name -> what a model file would call it."""
