"""Where a measured angle puts the tail marker of a simulated body."""

import numpy as np


def measured_tail(markers: np.ndarray, sin_theta: np.ndarray) -> np.ndarray:
    """The tail [m] [n, 2] at its simulated distance from the middle marker, in the measured direction.

    markers [m] [n, 3, 2]: simulated head, middle, tail; sin_theta [n]: measured, the run's offset taken out.
    """
    body, fin = markers[:, 1] - markers[:, 0], markers[:, 2] - markers[:, 1]
    sine = np.clip(sin_theta, -1.0, 1.0)
    cosine = np.sqrt(1.0 - sine**2)
    turned = np.stack(
        [body[:, 0] * cosine - body[:, 1] * sine, body[:, 0] * sine + body[:, 1] * cosine], axis=-1
    )
    ratio = np.linalg.norm(fin, axis=-1) / np.linalg.norm(body, axis=-1)
    return markers[:, 1] + turned * ratio[:, None]
