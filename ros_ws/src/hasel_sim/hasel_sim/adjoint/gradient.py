# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A run with everything kept that the way back needs, and the whole way back through it.

Weights of the measured angles become weights of the markers, observation effects included, then of positions.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from hasel_recording.recording import sin_theta_from_markers

from hasel_sim.adjoint.reverse import StepBack, reverse_start, reverse_step
from hasel_sim.dynamics.generalised_alpha import SolvedStep
from hasel_sim.dynamics.parameter_columns import ResidualColumns, ResidualSlope
from hasel_sim.dynamics.statics import initial_state
from hasel_sim.effects.base import ObservationEffect, guarded
from hasel_sim.mechanics.state import State
from hasel_sim.model.model_parameters import outline_names
from hasel_sim.model_mesh import observe
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.simulate import slope_by_observation

_STEP = 1e-6


@dataclass(frozen=True)
class Trajectory:
    """The first state, every step in the parts it was followed in, and what the camera sees.

    shapes: nodal positions [m] [steps + 1, nodes, 2]; markers and lines across the body through them:
    [steps + 1, 3, 2].
    """

    prepared: PreparedRun
    start: State
    steps: list[list[SolvedStep]]
    shapes: np.ndarray
    markers: np.ndarray
    lines: np.ndarray

    @property
    def series(self) -> np.ndarray:
        """The measured sin theta at the step boundaries, [steps + 1]."""
        values = self.prepared.model.effect_values()
        time = self.prepared.plan.boundaries
        return observe(time, self.markers, self.lines, self.prepared.observed_by, values)


def follow(prepared: PreparedRun, contraction: np.ndarray) -> Trajectory:
    """Step through a run driven by contractions [steps, 2] at the balance times."""
    stepper, drives = prepared.stepper, prepared.drives(contraction)
    state, _ = initial_state(
        stepper.system, prepared.start_drive, prepared.load_factor, [], prepared.held_shape
    )
    stepper.start(state, prepared.start_drive)
    positions, steps, start = [state.position[..., 0]], [], state
    for drive, c in zip(drives, prepared.plan.coefficients, strict=True):
        steps.append(stepper.follow(state, drive, c))
        state = steps[-1][-1].after
        positions.append(state.position[..., 0])
    shapes = np.array(positions)
    return Trajectory(prepared, start, steps, shapes, *prepared.rows(shapes))


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


@dataclass(frozen=True)
class Gradient:
    """Derivatives of a weighted sum of the angles or positions.

    contraction: [steps, muscles]; parameters: by the prepared run's named parameters at a fixed contraction; outline:
    by the outline's coefficients, empty where not asked for.
    """

    contraction: np.ndarray
    parameters: np.ndarray
    outline: np.ndarray


def gradient(trajectory: Trajectory, weights: np.ndarray, with_outline: bool) -> Gradient:
    """Derivatives of weights . sin theta, for weights at the step boundaries [steps + 1]."""
    prepared = trajectory.prepared
    where, across = reverse_observation(trajectory, weights)

    def add_weights(boundary: int, out: np.ndarray) -> None:
        prepared.rows.add_pulled_back(where[boundary], across[boundary], out)

    seen = trajectory.markers, trajectory.lines
    direct = np.array([weights @ slope_by_observation(prepared, name, *seen) for name in prepared.names])
    return _reversed(trajectory, add_weights, direct, with_outline)


def gradient_of_shapes(trajectory: Trajectory, weights: np.ndarray, with_outline: bool) -> Gradient:
    """Derivatives of weights . nodal positions, for weights at the step boundaries [steps + 1, nodes, 2]."""

    def add_weights(boundary: int, out: np.ndarray) -> None:
        out += weights[boundary]

    return _reversed(trajectory, add_weights, np.zeros(len(trajectory.prepared.names)), with_outline)


def _reversed(
    trajectory: Trajectory,
    add_weights: Callable[[int, np.ndarray], None],
    direct: np.ndarray,
    with_outline: bool,
) -> Gradient:
    """The way back, with what add_weights adds to the weights of the positions at a boundary [nodes, 2].

    direct: what the parameters do beside the motion.
    """
    prepared = trajectory.prepared
    names, builder = prepared.names, prepared.builder
    coefficients = len(outline_names(prepared.model.description.body)) if with_outline else 0
    slopes: list[ResidualSlope] = list(prepared.residual_slopes)
    slopes += [builder.outline_slope(index) for index in range(coefficients)]
    columns = ResidualColumns(prepared.stepper.system, slopes)
    totals = np.concatenate([direct, np.zeros(coefficients)])
    steps, back = trajectory.steps, StepBack(prepared.stepper.system)
    contraction = np.zeros((len(steps), prepared.muscles))
    current = (steps[-1][-1].after if steps else trajectory.start).zeros()
    for step in range(len(steps) - 1, -1, -1):
        add_weights(step + 1, current.position[..., 0])
        for part in reversed(steps[step]):
            current, by_contraction, by_parameter = reverse_step(back, part, current, columns)
            contraction[step] += by_contraction
            totals += by_parameter
    add_weights(0, current.position[..., 0])
    totals += reverse_start(prepared, trajectory.start, current, columns)
    return Gradient(contraction, totals[: len(names)], totals[len(names) :])
