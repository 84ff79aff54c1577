"""A BendingAngle message as the mapping that McapRecorder writes."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np


def bending_angle_message(
    sin_theta: float,
    theta: float | None = None,
    sin_theta_standard_deviation: float = math.nan,
    marker_names: Sequence[str] = (),
    pixels: np.ndarray | None = None,
    metres: np.ndarray | None = None,
    quality: Sequence[float] | None = None,
    doubt: int = 0,
) -> dict[str, Any]:
    """Return every field but the header, which the recorder makes from the stamp.

    sin_theta: NaN for a frame without an angle. theta [rad]: None takes the arcsine. pixels (y down), metres (y up):
    [m, 2] in the order of marker_names, or None. quality: [m]; None: not known.
    """
    count = len(marker_names) if pixels is not None or metres is not None else 0
    unknown = np.full((count, 2), math.nan)
    pixels = unknown if pixels is None else np.asarray(pixels, dtype=float)
    metres = unknown[:0] if metres is None else np.asarray(metres, dtype=float)
    return {
        "sin_theta": sin_theta,
        "sin_theta_standard_deviation": sin_theta_standard_deviation,
        "theta": math.asin(max(-1.0, min(1.0, sin_theta))) if theta is None else theta,
        "marker_name": list(marker_names)[:count],
        "marker_x": pixels[:, 0].tolist(),
        "marker_y": pixels[:, 1].tolist(),
        "marker_quality": [math.nan] * count if quality is None else [float(each) for each in quality],
        "marker_x_m": metres[:, 0].tolist(),
        "marker_y_m": metres[:, 1].tolist(),
        "doubt": doubt,
        "valid": math.isfinite(sin_theta),
    }
