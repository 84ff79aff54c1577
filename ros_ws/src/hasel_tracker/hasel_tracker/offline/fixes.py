"""Corrections by hand: frames, and where the markers are in them."""

from pathlib import Path
from typing import Any

import numpy as np
import yaml

from hasel_tracker.errors import TrackerError

EXAMPLE = "- {frame: 120, at: [[420, 540], [953, 540], [1529, 546]]}"


def read_fixes(path: Path) -> dict[int, np.ndarray]:
    """Read a YAML list of frames (counted from 0) and positions (m, 2) [px], head first; raises TrackerError."""
    try:
        content = yaml.safe_load(Path(path).read_text())
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        raise TrackerError(f"The corrections {path} cannot be read: {str(error).splitlines()[0]}.") from error
    if not isinstance(content, list) or not content:
        raise TrackerError(
            f"The corrections {path} are not a list; write a line such as `{EXAMPLE}` for each frame."
        )
    return dict(_fix(path, entry) for entry in content)


def _fix(path: Path, entry: Any) -> tuple[int, np.ndarray]:
    try:
        frame, points = int(entry["frame"]), np.array(entry["at"], float)
        if frame < 0 or points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
            raise ValueError
    except (TypeError, KeyError, ValueError):
        raise TrackerError(
            f"The corrections {path} have the entry {entry}; expected a frame and its markers, such as `{EXAMPLE}`."
        ) from None
    return frame, points
