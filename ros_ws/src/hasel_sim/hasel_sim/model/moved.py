"""Where the points of a body go when its shape changes: spine, soft halves and fin each keep their proportions."""

import numpy as np

from hasel_sim.model.body import Body


def moved_points(points: np.ndarray, before: Body, after: Body) -> np.ndarray:
    """Points [m] [n, 2] of one body at the same places of another, of the same length.

    Along the body x stays, along the fin it keeps its share of the fin; across, a point keeps its share of the spine's
    half thickness, or of the soft half between the spine and the outline. Continuous, and linear within each part.
    """
    x, y = np.asarray(points, dtype=float).T
    length = before.length_m
    fins = [body.whole_length_m - length for body in (before, after)]
    stretch = fins[1] / fins[0] if fins[0] > 0 else 1.0
    behind = x > length
    spines = [0.5 * body.spine_thickness_m for body in (before, after)]
    heights = [body.half_heights(np.minimum(x, length) / length) for body in (before, after)]
    size = np.abs(y)
    within = size <= spines[0]
    in_spine = size * (spines[1] / spines[0] if spines[0] > 0 else 1.0)
    share = (size - spines[0]) / np.where(within, 1.0, heights[0] - spines[0])
    in_soft = spines[1] + share * (heights[1] - spines[1])
    across = np.sign(y) * np.where(within, in_spine, in_soft)
    return np.column_stack([np.where(behind, length + stretch * (x - length), x), across])
