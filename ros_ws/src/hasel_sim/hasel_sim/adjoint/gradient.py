"""The whole way back through a run."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from hasel_sim.adjoint.observed import reverse_observation
from hasel_sim.adjoint.reverse import reverse_start, reverse_step
from hasel_sim.adjoint.step_back import StepBack
from hasel_sim.adjoint.trajectory import Trajectory
from hasel_sim.adjoint.weights import no_weights
from hasel_sim.mechanics.residual_columns import ResidualColumns
from hasel_sim.mechanics.residual_slopes import ResidualSlope
from hasel_sim.model.model_parameters import outline_names
from hasel_sim.simulate import slope_by_observation


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

    seen = [
        slope_by_observation(prepared, name, trajectory.markers, trajectory.lines) for name in prepared.names
    ]
    direct = np.array([weights @ series for series in seen])
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
    current = no_weights(steps[-1][-1].after if steps else trajectory.start)
    for step in range(len(steps) - 1, -1, -1):
        add_weights(step + 1, current.position[..., 0])
        for part in reversed(steps[step]):
            current, by_contraction, by_parameter = reverse_step(back, part, current, columns)
            contraction[step] += by_contraction
            totals += by_parameter
    add_weights(0, current.position[..., 0])
    totals += reverse_start(
        prepared.stepper.system,
        trajectory.start,
        prepared.start_drive,
        prepared.load_factor,
        prepared.held_shape is None,
        current,
        columns,
    )
    return Gradient(contraction, totals[: len(names)], totals[len(names) :])
