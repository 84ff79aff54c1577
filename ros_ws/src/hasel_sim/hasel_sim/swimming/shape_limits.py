"""What a body's shape has to keep to while it is varied: the outline its area and height, the spine its cover."""

import numpy as np
from scipy.integrate import trapezoid

from hasel_sim.swimming.variables import HALF_OR_DOUBLE, LARGEST, OUTLINE, Variables

_THICKNESS = "body.spine.thickness_m"
_COVER = 1.1
"""Height of the body over its spine's thickness, at least."""
_STATIONS = np.linspace(0.0, 1.0, 41)


def shape_limits(variables: Variables) -> list[dict]:
    """Constraints of x, for a minimiser: an outline keeps its area and half to twice its height, no spine is bare."""

    def heights(x: np.ndarray) -> tuple[np.ndarray, float]:
        """Heights [m] along the body, and the spine's thickness [m]."""
        body = variables.freed.with_values(variables.values(x)).described.body
        return 2 * body.half_heights(_STATIONS), body.spine_thickness_m

    def cover(x: np.ndarray) -> np.ndarray:
        height, thickness = heights(x)
        return (height - _COVER * thickness) / height.max()

    out: list[dict] = []
    start = heights(variables.start)[0]
    if OUTLINE in variables.vary:
        low, high = HALF_OR_DOUBLE
        out = [
            {"type": "eq", "fun": lambda x: trapezoid(heights(x)[0]) / trapezoid(start) - 1.0},
            {"type": "ineq", "fun": lambda x: heights(x)[0] / start - low},
            {"type": "ineq", "fun": lambda x: high - heights(x)[0] / start},
        ]
    if {OUTLINE, LARGEST, _THICKNESS, "body.height_m"} & set(variables.vary):
        out.append({"type": "ineq", "fun": cover})
    return out
