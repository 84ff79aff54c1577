"""Runs simulated side by side: bodies with one mesh step together, each in a lane of the compiled loops."""

from collections.abc import Sequence

import numpy as np

from hasel_sim.dynamics.generalised_alpha import StepCoefficients
from hasel_sim.dynamics.integrator import Integrator, Stepper
from hasel_sim.dynamics.parameter_columns import NoSlope, beside
from hasel_sim.dynamics.system import System
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.state import DriveState, Motion, NodeTrajectories, State, StateSlopes
from hasel_sim.prepared_run import PreparedRun


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

    def follow(self, marcher: Integrator, step: int, lane: int, slopes: StateSlopes) -> None:
        """Make a step that failed in a lane by itself, in parts, and write its end back into the lane.

        Raises SimulationError where that fails too.
        """
        alone = Stepper(self.system, marcher.tolerance, self.parameters)
        alone.begin(marcher.jerk[..., [lane]], marcher.stress[..., [lane]])
        own, own_slopes = marcher.state.lane(lane), slopes.lane(lane)
        derivatives = own_slopes, self.contraction_slopes[step]
        parts = alone.follow(own, self.drive(step), self.plan.coefficients[step], derivatives)
        marcher.state.put(lane, parts[-1].after)
        slopes.put(lane, own_slopes)
        marcher.jerk[..., lane], marcher.stress[..., lane] = alone.jerk[..., 0], alone.stress[..., 0]


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
    marcher = Integrator(system, tolerance, columns)
    start = DriveState.beside([lane.prepared.start_drive for lane in filled])
    motion = Motion(state.position, state.velocity, state.acceleration)
    stress = system.second_piola(motion, start, system.memory(state))
    marcher.begin(state, stress, np.zeros_like(state.position))
    drives = DriveState(*(_beside(filled, name, steps) for name in ("voltage", "contraction", "time")))
    kinds, coefficients = _coefficients(filled, steps)
    ends = np.array([*map(len, lanes), *[0] * (count - len(lanes))])
    marcher.plan(
        drives, kinds, coefficients, ends, seen, slopes, _beside(filled, "contraction_slopes", steps)
    )
    step, last = 0, int(ends.max())
    while step < last:
        reached = marcher.advance(step, last)
        step = min(reached + 1, last)
        if reached == last:
            continue
        for index in np.flatnonzero((step <= ends) & ~marcher.arrived).tolist():
            try:
                lanes[index].follow(marcher, step - 1, index, slopes)
            except SimulationError as error:
                errors[index], ends[index] = error, 0
        seen.note(step, state, slopes)
        last = int(ends.max())
    marcher.say_what_runs_as_python()
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
