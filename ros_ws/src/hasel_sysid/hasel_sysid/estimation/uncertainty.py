"""Standard errors that do not take neighbouring frames for independent ones."""

import numpy as np

from hasel_sysid.estimation.directions import seen_directions
from hasel_sysid.noise import NoiseModel


def parameter_covariance(
    jacobian: np.ndarray, noise: NoiseModel, runs: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Covariance [parameters, parameters] of least-squares estimates, and which are not determined [parameters].

    H^-1 (J^T Gamma J) H^-1 with H = J^T J and Gamma the covariance of the noise within each run (the "sandwich";
    White 1980, Newey and West 1987). Entries of undetermined parameters are infinite.
    """
    seen = seen_directions(jacobian)
    middle = seen.left.T @ noise.covariance_product(seen.left, runs)
    covariance = seen.to_parameters @ middle @ seen.to_parameters.T
    covariance[seen.undetermined, :] = np.inf
    covariance[:, seen.undetermined] = np.inf
    return covariance, seen.undetermined
