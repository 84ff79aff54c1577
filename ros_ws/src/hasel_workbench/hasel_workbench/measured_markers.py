"""Where the measured markers lie on the simulated body."""

import numpy as np
from hasel_sim.model import Model
from hasel_sysid.experiment import Experiment
from hasel_sysid.report.shape import measured_tail


def measured_markers(
    experiment: Experiment, simulated: np.ndarray, offset: float, model: Model
) -> np.ndarray:
    """Head, middle and tail as measured, [m] [n, 3, 2], in the simulated body's frame; NaN where not measured.

    simulated [m] [n, markers, 2]; offset: of the measured sin theta, taken out where only the angle is known.
    A clamped body's markers lie where they were measured. A free body's place in the image is not simulated: its head
    and middle marker are laid on the simulated ones, in size as in direction, and the tail shows what differs. Where
    only the angle was recorded the tail is drawn at the simulated distance, in the measured direction.
    """
    head, middle = simulated[:, 0], simulated[:, 1]
    recorded = experiment.recording.angle_markers
    if recorded is not None and experiment.recording.marker_unit == "m" and _is_held(model):
        return recorded.copy()
    if recorded is None:
        end = measured_tail(simulated, experiment.sin_theta - offset)
    else:
        if experiment.recording.marker_unit == "px":
            recorded = recorded * (1.0, -1.0)
        first, second = recorded[:, 1] - recorded[:, 0], recorded[:, 2] - recorded[:, 1]
        end = middle + _product(middle - head, _quotient(second, first))
    known = np.isfinite(end).all(axis=-1)[:, None]
    return np.stack([np.where(known, head, np.nan), np.where(known, middle, np.nan), end], axis=1)


def _is_held(model: Model) -> bool:
    """Whether markers or an end of the body are fixed in the laboratory."""
    markers = model.description.markers.values()
    return any(marker.fixed for marker in markers) or model.description.body.clamped


def _product(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Of vectors as complex numbers [n, 2]: turned and stretched."""
    (a, b), (c, d) = first.T, second.T
    return np.stack([a * c - b * d, a * d + b * c], axis=-1)


def _quotient(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """The turn and stretch [n, 2] that takes the second [n, 2] to the first."""
    conjugate = second * (1.0, -1.0)
    return _product(first, conjugate) / (second**2).sum(axis=-1)[:, None]
