"""Simulate runs with a model, with derivatives of the angle by any of its parameters."""

import warnings
from collections.abc import Sequence

import numpy as np

from hasel_sim.errors import HaselSimError
from hasel_sim.lanes import Lane, columns_of_lanes, step_together
from hasel_sim.mechanics.state import NodeTrajectories
from hasel_sim.model import Model
from hasel_sim.model.constants import shape_constants
from hasel_sim.observation import observe
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.run import Run, Simulation
from hasel_sim.simd import LANES


def simulate(model: Model, run: Run, slopes_by: Sequence[str] = (), keep_shapes: bool = False) -> Simulation:
    """Simulate one run.

    slopes_by: names of parameters by which sin theta is differentiated, exactly to the tolerance of the steps.
    Raises SimulationError when the motion cannot be followed, ModelError for an unknown parameter.
    """
    aimless = model.has_muscles and model.description.muscle is None and not len(model.levels)
    if aimless and run.schedule is not None and run.schedule.signal.any():
        warnings.warn(
            f"model '{model.name}' has no amplitudes, so nothing that drives run '{run.name}' contracts its muscles: "
            "give it some with model.with_levels([…]), or fit it",
            stacklevel=2,
        )
    (result,) = simulate_many([(model, run)], slopes_by, keep_shapes)
    if isinstance(result, Exception):
        raise result
    return result


def simulate_many(
    cases: Sequence[tuple[Model, Run]], slopes_by: Sequence[str] = (), keep_shapes: bool = False
) -> list[Simulation | HaselSimError]:
    """Simulate several runs, models or parameter values; those that share a mesh and effects go side by side.

    Every result is what `simulate` gives, or the error that it raises, in the order of the cases.
    """
    results: list[Simulation | HaselSimError | None] = [None] * len(cases)
    batches: dict[tuple, list[tuple[int, PreparedRun]]] = {}
    of_model: dict[int, PreparedRun] = {}
    for index, (model, run) in enumerate(cases):
        try:
            prepared = PreparedRun(model, run, tuple(slopes_by), like=of_model.get(id(model)))
        except HaselSimError as error:
            results[index] = error
            continue
        of_model.setdefault(id(model), prepared)
        batches.setdefault(kind_of(model), []).append((index, prepared))
    for batch in batches.values():
        batch.sort(key=lambda case: -len(case[1].plan.coefficients))
        for first in range(0, len(batch), LANES[-1]):
            numbers, prepared = zip(*batch[first : first + LANES[-1]], strict=True)
            for index, result in zip(numbers, _simulate_beside(prepared, keep_shapes), strict=True):
                results[index] = result
    return results


def kind_of(model: Model) -> tuple:
    """What models must have in common to be simulated side by side: mesh, effects, and which of these have a size; the
    parameters' values may differ.
    """
    values = model.effect_values()
    effects = tuple(sorted((e.source or e.id, e.is_null_at(values[e.id])) for e in model.effects))
    shape = tuple(shape_constants(model.described).values())
    return model.description.model_dump_json(exclude={"name"}), shape, effects


def _simulate_beside(prepared: Sequence[PreparedRun], keep_shapes: bool) -> list[Simulation | HaselSimError]:
    slopes = [p.contraction_slopes(p.plan.balance_times) for p in prepared]
    columns = columns_of_lanes(prepared, slopes)
    results: list[Simulation | HaselSimError | None] = [None] * len(prepared)
    lanes: dict[int, Lane] = {}
    for index, (p, moves, s) in enumerate(zip(prepared, columns, slopes, strict=True)):
        try:
            lanes[index] = Lane(p, moves, s)
        except HaselSimError as error:
            results[index] = error
    if lanes:
        count = next(count for count in LANES if count >= len(lanes))
        seen, errors = step_together(list(lanes.values()), count, keep_shapes)
        for place, ((index, lane), error) in enumerate(zip(lanes.items(), errors, strict=True)):
            results[index] = error or _observed(lane, seen, place)
    return results


def _observed(lane: Lane, seen: NodeTrajectories, place: int) -> Simulation:
    prepared, plan, until = lane.prepared, lane.plan, len(lane) + 1
    markers, lines = prepared.rows.interpolated(seen.local[:until, ..., place])
    d_markers, d_lines = prepared.rows.interpolated_slopes(seen.slopes[:until, ..., place])
    derivatives = _observed_slopes(prepared, markers, lines, d_markers, d_lines, lane.moves)
    values = prepared.model.effect_values()
    return Simulation(
        prepared.run,
        prepared.at_frames(observe(plan.boundaries, markers, lines, prepared.observed_by, values)),
        prepared.names,
        prepared.at_frames(derivatives),
        prepared.at_frames(markers),
        prepared.at_frames(prepared.contraction(plan.boundaries)),
        prepared.at_frames(seen.shapes[:until, ..., place]) if len(seen.shapes) else None,
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
    more, less, width = prepared.declared(name).around(model.parameters[name].value)
    above, below = (
        observe(
            time, markers, lines, prepared.observed_by, model.effect_values({**model.values, name: value})
        )
        for value in (more, less)
    )
    return (above - below) / width
