"""Which combinations of parameters the residuals see, and what parameters follow a change of the series."""

from dataclasses import dataclass

import numpy as np

_UNSEEN = 1e-7
"""A direction of the scaled parameters with less than this share of the strongest one's response is not seen."""


@dataclass(frozen=True, eq=False)
class Directions:
    """Singular directions of the derivatives by the parameters, each parameter scaled to the same response.

    left [frames, seen]: orthonormal changes of the series; to_parameters [parameters, seen]: the change of the
    parameters behind each; undetermined [parameters]: those that an unseen direction moves.
    """

    left: np.ndarray
    to_parameters: np.ndarray
    undetermined: np.ndarray

    def estimate(self, change: np.ndarray) -> np.ndarray:
        """Least-squares change of the parameters [parameters] that follows a change of the series [frames]."""
        return self.to_parameters @ (self.left.T @ change)


def seen_directions(jacobian: np.ndarray) -> Directions:
    """Directions of derivatives [frames, parameters]."""
    size = jacobian.shape[1]
    if size == 0:
        return Directions(np.zeros((len(jacobian), 0)), np.zeros((0, 0)), np.zeros(0, dtype=bool))
    scale = np.linalg.norm(jacobian, axis=0)
    safe = np.where(scale > 0, scale, 1.0)
    left, strength, right = np.linalg.svd(jacobian / safe, full_matrices=False)
    seen = strength > _UNSEEN * strength[0] if strength[0] > 0 else np.zeros(size, dtype=bool)
    undetermined = (scale == 0) | (np.abs(right[~seen]) > 1e-3).any(axis=0)
    return Directions(left[:, seen], right[seen].T / strength[seen] / safe[:, None], undetermined)
