"""From weights of the measured angles back to weights of the markers; observation effects included."""

import numpy as np
from hasel_recording.recording import sin_theta_from_markers

from hasel_sim.adjoint.trajectory import Trajectory
from hasel_sim.effects.base import ObservationEffect, guarded

_STEP = 1e-6


def reverse_observation(trajectory: Trajectory, weights: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weights of marker positions and of the lines across, both [boundaries, 3, 2], from those of the angles.

    Marker positions map to an angle instant by instant: twelve differences serve all instants.
    """
    weights = _reverse_angles(trajectory, weights)
    both = np.stack([trajectory.markers, trajectory.lines])
    out = np.zeros_like(both)
    for place in np.ndindex(2, 3, 2):
        scale = _STEP * (1.0 if place[0] else np.ptp(trajectory.markers))
        shift = np.zeros_like(both)
        shift[place[0], :, place[1], place[2]] = scale
        difference = _angles(trajectory, *(both + shift)) - _angles(trajectory, *(both - shift))
        out[place[0], :, place[1], place[2]] = weights * difference / (2 * scale)
    return out[0], out[1]


def _angles(trajectory: Trajectory, markers: np.ndarray, lines: np.ndarray) -> np.ndarray:
    """sin theta before the effects that act on the series itself."""
    values = trajectory.prepared.model.effect_values()
    for effect in trajectory.prepared.observed_by:
        markers = guarded(effect, "markers", markers, lines, values[effect.id])
    return sin_theta_from_markers(markers)


def _reverse_angles(trajectory: Trajectory, weights: np.ndarray) -> np.ndarray:
    """Back through the effects that act on the series; they may mix instants, so each instant is moved by itself."""
    prepared = trajectory.prepared
    effects = [e for e in prepared.observed_by if type(e).angle is not ObservationEffect.angle]
    if not effects:
        return weights
    values, time = prepared.model.effect_values(), prepared.plan.boundaries

    def measured(series: np.ndarray) -> np.ndarray:
        for effect in effects:
            series = guarded(effect, "angle", time, series, values[effect.id])
        return series

    series = _angles(trajectory, trajectory.markers, trajectory.lines)
    out = np.empty_like(weights)
    for instant in range(len(series)):
        shift = np.zeros_like(series)
        shift[instant] = _STEP
        out[instant] = weights @ (measured(series + shift) - measured(series - shift)) / (2 * _STEP)
    return out
