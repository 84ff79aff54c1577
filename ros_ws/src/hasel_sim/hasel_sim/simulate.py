"""Simulate runs with a model, with derivatives of the angle by any of its parameters."""

from collections.abc import Sequence

import numpy as np

from hasel_sim.build import difference_points
from hasel_sim.mechanics.initial import initial_state
from hasel_sim.mechanics.residual_slopes import NoSlope
from hasel_sim.model import Model
from hasel_sim.observation import observe
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.run import Run, Simulation


def simulate(model: Model, run: Run, slopes_by: Sequence[str] = (), keep_shapes: bool = False) -> Simulation:
    """Simulate one run.

    slopes_by: names of parameters by which sin theta is differentiated, exactly to the tolerance of the steps.
    Raises SimulationError when the motion cannot be followed, ModelError for an unknown parameter.
    """
    prepared = PreparedRun(model, run, tuple(slopes_by))
    plan = prepared.plan
    contraction_slopes = prepared.contraction_slopes(plan.balance_times)
    residual_slopes = [prepared.builder.residual_slope(name) for name in prepared.names]
    # columns that move nothing in this run cost nothing
    moves = [
        column
        for column, slope in enumerate(residual_slopes)
        if not isinstance(slope, NoSlope) or np.any(contraction_slopes[:, column])
    ]
    contraction_slopes, moving = contraction_slopes[:, moves], [residual_slopes[n] for n in moves]
    stepper, rows = prepared.stepper, prepared.rows
    state, slopes = initial_state(
        stepper.system, prepared.start_drive, prepared.load_factor, moving, prepared.held_shape
    )
    seen, d_seen = [rows.local(state.position)], [rows.local(slopes.position)]
    shapes = [state.position]
    drives = prepared.drives(prepared.contraction(plan.balance_times))
    for step, (drive, c) in enumerate(zip(drives, plan.coefficients, strict=True)):
        for part in stepper.follow(state, drive, c):
            if moves:
                slopes = stepper.step_slopes(part, slopes, moving, contraction_slopes[step])
            state = part.after
        d_seen.append(rows.local(slopes.position))
        seen.append(rows.local(state.position))
        if keep_shapes:
            shapes.append(state.position)
    markers, lines = rows.interpolated(np.array(seen))
    values = model.effect_values()
    d_markers, d_lines = rows.interpolated_slopes(np.array(d_seen))
    derivatives = _observed_slopes(prepared, markers, lines, d_markers, d_lines, moves)
    return Simulation(
        run,
        prepared.at_frames(observe(plan.boundaries, markers, lines, prepared.observed_by, values)),
        prepared.names,
        prepared.at_frames(derivatives),
        prepared.at_frames(markers),
        prepared.at_frames(prepared.contraction(plan.boundaries)),
        prepared.at_frames(np.array(shapes)) if keep_shapes else None,
    )


def _observed_slopes(
    prepared: PreparedRun, markers, lines, d_markers, d_lines, moves: list[int]
) -> np.ndarray:
    """Derivatives of the measured series [boundaries, columns].

    d_markers, d_lines: derivatives by the parameters numbered in `moves`.
    """
    time, effects = prepared.plan.boundaries, prepared.observed_by
    values = prepared.model.effect_values()
    derivatives = np.zeros((len(time), len(prepared.names)))
    for index, column in enumerate(moves):
        direction, across = d_markers[:, index], d_lines[:, index]
        step = 1e-6 / max(np.abs(direction).max(), 1e-12)
        above = observe(time, markers + step * direction, lines + step * across, effects, values)
        below = observe(time, markers - step * direction, lines - step * across, effects, values)
        derivatives[:, column] = (above - below) / (2 * step)
    for column, name in enumerate(prepared.names):
        derivatives[:, column] += slope_by_observation(prepared, name, markers, lines)
    return derivatives


def slope_by_observation(prepared: PreparedRun, name: str, markers, lines) -> np.ndarray:
    """Derivative of the measured series [boundaries] by a parameter for given marker motions; mostly zero."""
    time, model = prepared.plan.boundaries, prepared.model
    if name.rpartition(".")[0] not in {effect.id for effect in prepared.observed_by}:
        return np.zeros(len(time))
    more, less, width = difference_points(prepared.declared(name), model.parameters[name].value)
    above, below = (
        observe(
            time, markers, lines, prepared.observed_by, model.effect_values({**model.values, name: value})
        )
        for value in (more, less)
    )
    return (above - below) / width
