# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Simulate runs with a model, with derivatives of the angle by any of its parameters, several side by side in lanes."""

import warnings
from collections.abc import Sequence

import numpy as np

from hasel_sim.dynamics.generalised_alpha import StepCoefficients
from hasel_sim.dynamics.integrator import Integrator, Stepper
from hasel_sim.dynamics.parameter_columns import NoSlope, beside
from hasel_sim.dynamics.system import System
from hasel_sim.errors import HaselSimError, SimulationError
from hasel_sim.mechanics.state import DriveState, Motion, NodeTrajectories, State, StateSlopes
from hasel_sim.model import Model
from hasel_sim.model.model_parameters import shape_constants
from hasel_sim.model_mesh import observe
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.run import Run, Simulation
from hasel_sim.simd import LANES

ModelKind = tuple[str, tuple[float, ...], tuple[tuple[str, bool], ...]]
"""What `kind_of` gives."""


class Lane:
    """One run with everything that stepping needs of it, and what is seen of its motion."""

    def __init__(self, prepared: PreparedRun, moves: list[int], contraction_slopes: np.ndarray) -> None:
        self.prepared, self.plan, self.moves = prepared, prepared.plan, moves
        self.system = prepared.stepper.system
        self.parameters = [prepared.residual_slopes[column] for column in moves]
        self.contraction_slopes = contraction_slopes[:, moves]
        self.time = self.plan.balance_times
        self.voltage, self.contraction = prepared.voltage(self.time), prepared.contraction(self.time)
        self.state, self.slopes = prepared.start(moves)

    def __len__(self) -> int:
        """How many steps there are."""
        return len(self.time)

    def drive(self, step: int) -> DriveState:
        """The drive at the balance of a step."""
        return DriveState.single(self.voltage[step], self.contraction[step], self.time[step])

    def follow(self, integrator: Integrator, step: int, lane: int, slopes: StateSlopes) -> None:
        """Make a step that failed in a lane by itself, in parts, and write its end back into the lane.

        Raises SimulationError where that fails too.
        """
        alone = Stepper(self.system, integrator.tolerance, self.parameters)
        alone.begin(integrator.jerk[..., [lane]], integrator.stress[..., [lane]])
        own, own_slopes = integrator.state.lane(lane), slopes.lane(lane)
        derivatives = own_slopes, self.contraction_slopes[step]
        parts = alone.follow(own, self.drive(step), self.plan.coefficients[step], derivatives)
        integrator.state.put(lane, parts[-1].after)
        slopes.put(lane, own_slopes)
        integrator.jerk[..., lane], integrator.stress[..., lane] = alone.jerk[..., 0], alone.stress[..., 0]


def columns_of_lanes(prepared: Sequence[PreparedRun], slopes: Sequence[np.ndarray]) -> list[list[int]]:
    """For the run of every lane the numbers of the parameters whose derivatives are followed, equally many.

    What the mechanics sees of any run is followed in all lanes. What acts through the contraction alone is followed
    where it does: amplitudes of voltages that a run has not cost nothing.
    slopes: derivatives of the contraction [steps, parameters, muscles] of every run.
    """
    seen = {
        n for run in prepared for n, slope in enumerate(run.residual_slopes) if not isinstance(slope, NoSlope)
    }
    driven = [set(np.flatnonzero(by_drive.any(axis=(0, 2))).tolist()) - seen for by_drive in slopes]
    every, count = set().union(*driven), max(map(len, driven))
    return [sorted(seen) + sorted([*own, *sorted(every - own)[: count - len(own)]]) for own in driven]


def step_together(
    lanes: Sequence[Lane], count: int, keep_shapes: bool
) -> tuple[NodeTrajectories, list[SimulationError | None]]:
    """Step all lanes to their ends; what is seen, and what went wrong in each lane, come back.

    count: how many lanes the loops are compiled for; those without a run repeat the first and are not stepped.
    A lane whose step fails makes it by itself, divided; one that fails even so stands still from there on.
    """
    filled = [*lanes, *[lanes[0]] * (count - len(lanes))]
    system, tolerance = System.beside([lane.system for lane in filled]), lanes[0].prepared.stepper.tolerance
    state, slopes = State.beside([x.state for x in filled]), StateSlopes.beside([x.slopes for x in filled])
    columns = [beside(each) for each in zip(*(lane.parameters for lane in filled), strict=True)]
    errors: list[SimulationError | None] = [None] * len(lanes)
    steps = max(map(len, lanes))
    seen = NodeTrajectories.of(lanes[0].prepared.rows.nodes, steps + 1, state, len(columns), keep_shapes)
    seen.note(0, state, slopes)
    if steps == 0:
        return seen, errors
    integrator = Integrator(system, tolerance, columns)
    start = DriveState.beside([lane.prepared.start_drive for lane in filled])
    motion = Motion(state.position, state.velocity, state.acceleration)
    stress = system.second_piola(motion, start, system.memory(state))
    integrator.begin(state, stress, np.zeros_like(state.position))
    drives = DriveState(*(_beside(filled, name, steps) for name in ("voltage", "contraction", "time")))
    kinds, coefficients = _coefficients(filled, steps)
    ends = np.array([*map(len, lanes), *[0] * (count - len(lanes))])
    integrator.plan(
        drives, kinds, coefficients, ends, seen, slopes, _beside(filled, "contraction_slopes", steps)
    )
    step, last = 0, int(ends.max())
    while step < last:
        reached = integrator.advance(step, last)
        step = min(reached + 1, last)
        if reached == last:
            continue
        for index in np.flatnonzero((step <= ends) & ~integrator.arrived).tolist():
            try:
                lanes[index].follow(integrator, step - 1, index, slopes)
            except SimulationError as error:
                errors[index], ends[index] = error, 0
        seen.note(step, state, slopes)
        last = int(ends.max())
    integrator.say_what_runs_as_python()
    for index in range(len(lanes)):
        if errors[index] is None and not np.isfinite(slopes.position[..., index]).all():
            errors[index] = SimulationError(
                "the motion was found, its derivatives were not: the matrix of a step is singular; expected parameters "
                "at which the body stays whole: move extreme values back into their plausible range"
            )
    return seen, errors


def _beside(lanes: Sequence[Lane], name: str, steps: int) -> np.ndarray:
    """A series over the steps [steps, ..., lanes]; the last entry of a shorter one is repeated."""
    series = [getattr(lane, name) for lane in lanes]
    return np.stack([one[np.minimum(np.arange(steps), len(one) - 1)] for one in series], axis=-1)


def _coefficients(lanes: Sequence[Lane], steps: int) -> tuple[np.ndarray, list[StepCoefficients]]:
    """The kind of every step [steps], and the coefficients of all lanes for every kind."""
    each = [[lane.plan.coefficients[min(step, len(lane) - 1)] for step in range(steps)] for lane in lanes]
    kinds: list[int] = []
    known: dict[tuple[int, ...], int] = {}
    out: list[StepCoefficients] = []
    for here in zip(*each, strict=True):
        key = tuple(map(id, here))
        if key not in known:
            known[key] = len(out)
            out.append(StepCoefficients.beside(here))
        kinds.append(known[key])
    return np.array(kinds), out


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
    batches: dict[ModelKind, list[tuple[int, PreparedRun]]] = {}
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


def kind_of(model: Model) -> ModelKind:
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
    prepared: PreparedRun,
    markers: np.ndarray,
    lines: np.ndarray,
    d_markers: np.ndarray,
    d_lines: np.ndarray,
    moves: list[int],
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


def slope_by_observation(
    prepared: PreparedRun, name: str, markers: np.ndarray, lines: np.ndarray
) -> np.ndarray:
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
