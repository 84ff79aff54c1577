"""Standard errors that do not take neighbouring frames for independent ones."""

import numpy as np

from hasel_sysid.noise import NoiseModel

_UNSEEN = 1e-7
"""A direction of the scaled parameters with less than this share of the strongest one's response is not seen."""


def parameter_covariance(
    jacobian: np.ndarray, noise: NoiseModel, runs: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Covariance [parameters, parameters] of least-squares estimates, and which are not determined [parameters].

    H^-1 (J^T Gamma J) H^-1 with H = J^T J and Gamma the covariance of the noise within each run (the "sandwich";
    White 1980, Newey and West 1987). Entries of undetermined parameters are infinite.
    """
    size = jacobian.shape[1]
    if size == 0:
        return np.zeros((0, 0)), np.zeros(0, dtype=bool)
    scale = np.linalg.norm(jacobian, axis=0)
    scaled = jacobian / np.where(scale > 0, scale, 1.0)
    left, strength, right = np.linalg.svd(scaled, full_matrices=False)
    seen = strength > _UNSEEN * strength[0] if strength[0] > 0 else np.zeros(size, dtype=bool)
    undetermined = (scale == 0) | (np.abs(right[~seen]) > 1e-3).any(axis=0)
    to_parameters = right[seen].T / strength[seen]
    middle = left[:, seen].T @ noise.covariance_product(left[:, seen], runs)
    safe = np.where(scale > 0, scale, 1.0)
    covariance = to_parameters @ middle @ to_parameters.T / np.outer(safe, safe)
    covariance[undetermined, :] = np.inf
    covariance[:, undetermined] = np.inf
    return covariance, undetermined
