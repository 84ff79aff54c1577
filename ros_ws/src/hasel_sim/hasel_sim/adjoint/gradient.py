"""The whole way back through a run."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.adjoint.observed import reverse_observation
from hasel_sim.adjoint.reverse import reverse_start, reverse_step
from hasel_sim.adjoint.trajectory import Trajectory
from hasel_sim.adjoint.weights import no_weights
from hasel_sim.mechanics.residual_slopes import ResidualSlope
from hasel_sim.simulate import slope_by_observation


@dataclass(frozen=True)
class Gradient:
    """Derivatives of a weighted sum of the angles.

    contraction: [steps, muscles]; parameters: by the prepared run's named parameters at a fixed contraction; outline:
    by the outline's coefficients, empty where not asked for.
    """

    contraction: np.ndarray
    parameters: np.ndarray
    outline: np.ndarray


def gradient(trajectory: Trajectory, weights: np.ndarray, with_outline: bool) -> Gradient:
    """Derivatives of weights . sin theta, for weights at the step boundaries [steps + 1]."""
    prepared = trajectory.prepared
    names, builder = prepared.names, prepared.builder
    coefficients = len(builder.mesh.outline_slope) if with_outline else 0
    slopes: list[ResidualSlope] = list(prepared.residual_slopes)
    slopes += [builder.outline_slope(index) for index in range(coefficients)]
    seen = [slope_by_observation(prepared, name, trajectory.markers, trajectory.lines) for name in names]
    totals = np.array([weights @ series for series in seen] + [0.0] * coefficients)
    where, across = reverse_observation(trajectory, weights)

    steps = trajectory.steps
    contraction = np.zeros((len(steps), prepared.muscles))
    current = no_weights(steps[-1][-1].after if steps else trajectory.start)
    for step in range(len(steps) - 1, -1, -1):
        prepared.rows.add_pulled_back(where[step + 1], across[step + 1], current.position[..., 0])
        for part in reversed(steps[step]):
            current, by_contraction, by_parameter = reverse_step(prepared.stepper, part, current, slopes)
            contraction[step] += by_contraction
            totals += by_parameter
    prepared.rows.add_pulled_back(where[0], across[0], current.position[..., 0])
    totals += reverse_start(
        prepared.stepper.system,
        trajectory.start,
        prepared.start_drive,
        prepared.load_factor,
        prepared.held_shape is None,
        current,
        slopes,
    )
    return Gradient(contraction, totals[: len(names)], totals[len(names) :])
