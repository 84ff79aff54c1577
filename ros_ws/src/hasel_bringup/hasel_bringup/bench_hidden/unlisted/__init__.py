"""Effects that are hidden in the truth and stand in no catalogue, one user's file each."""

from pathlib import Path

_CLASSES = {
    "cubic_drag": "CubicDrag",
    "electrode_leakage": "ElectrodeLeakage",
    "heavier_body": "HeavierBody",
    "one_sided_dead_zone": "OneSidedDeadZone",
    "stirred_bath": "StirredBath",
    "tired_by_cycles": "TiredByCycles",
}
UNLISTED = {name: f"{Path(__file__).parent / name}.py:{kind}" for name, kind in _CLASSES.items()}
"""Effect id -> what a model file would name it by."""
