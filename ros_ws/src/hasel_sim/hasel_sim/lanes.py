"""Runs simulated side by side: bodies with one mesh step together, each in a lane of the compiled loops."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.generalised_alpha import StepCoefficients
from hasel_sim.mechanics.motion import DriveState
from hasel_sim.mechanics.residual_slopes import NoSlope
from hasel_sim.mechanics.state import State, StateSlopes
from hasel_sim.mechanics.stepper import Stepper
from hasel_sim.mechanics.system import System
from hasel_sim.prepared_run import PreparedRun


class Lane:
    """One run with everything that stepping needs of it, and what is seen of its motion."""

    def __init__(self, prepared: PreparedRun, moves: list[int], contraction_slopes: np.ndarray) -> None:
        self.prepared, self.plan = prepared, prepared.plan
        self.system = prepared.stepper.system
        self.parameters = [prepared.residual_slopes[column] for column in moves]
        self.contraction_slopes = contraction_slopes[:, moves]
        self.drives = prepared.drives(prepared.contraction(self.plan.balance_times))
        self.state, self.slopes = prepared.start(moves)

    def __len__(self) -> int:
        """How many steps there are."""
        return len(self.drives)

    def follow(self, stepper: Stepper, step: int, lane: int, state: State, slopes: StateSlopes) -> None:
        """Make a step that failed in a lane by itself, in parts, and write its end back into state and slopes.

        Raises SimulationError where that fails too.
        """
        alone = stepper.of_lane(lane, self.system)
        own, own_slopes = state.lane(lane), slopes.lane(lane)
        for part in alone.follow(own, self.drives[step], self.plan.coefficients[step]):
            if self.parameters:
                own_slopes = alone.step_slopes(
                    part, own_slopes, self.parameters, self.contraction_slopes[step][..., None]
                )
            own = part.after
        state.put(lane, own)
        slopes.put(lane, own_slopes)
        stepper.put_lane(lane, alone)


def moving_columns(prepared: PreparedRun, contraction_slopes: np.ndarray) -> list[int]:
    """Numbers of the parameters that move anything in this run; the others cost nothing."""
    return [
        column
        for column, slope in enumerate(prepared.residual_slopes)
        if not isinstance(slope, NoSlope) or np.any(contraction_slopes[:, column])
    ]


@dataclass(frozen=True)
class Seen:
    """What is kept of the motion of all lanes: at the markers [boundaries, markers, 8, 2, lanes], its derivatives

    [boundaries, columns, markers, 8, 2, lanes], and where asked for all positions [boundaries, nodes, 2, lanes].
    """

    local: np.ndarray
    slopes: np.ndarray
    shapes: np.ndarray | None

    @staticmethod
    def of(
        nodes: np.ndarray, boundaries: int, state: State, slopes: StateSlopes, keep_shapes: bool
    ) -> "Seen":
        """Room for so many boundaries; nodes: which the markers see [markers, 8]."""
        lanes = state.position.shape[-1]
        place = (*nodes.shape, 2, lanes)
        shapes = np.zeros((boundaries, *state.position.shape)) if keep_shapes else None
        return Seen(
            np.zeros((boundaries, *place)), np.zeros((boundaries, len(slopes.position), *place)), shapes
        )

    def note(self, boundary: int, nodes: np.ndarray, state: State, slopes: StateSlopes) -> None:
        """Keep what is seen at a boundary between steps."""
        self.local[boundary] = state.position[nodes]
        if self.slopes.shape[1]:
            self.slopes[boundary] = slopes.position[:, nodes]
        if self.shapes is not None:
            self.shapes[boundary] = state.position


def step_together(
    lanes: Sequence[Lane], count: int, keep_shapes: bool
) -> tuple[Seen, list[SimulationError | None]]:
    """Step all lanes to their ends; what is seen, and what went wrong in each lane, come back.

    count: how many lanes the loops are compiled for; those without a run repeat the first and are not stepped.
    A lane whose step fails makes it by itself, divided; one that fails even so stands still from there on.
    """
    filled = [*lanes, *[lanes[0]] * (count - len(lanes))]
    stepper = Stepper(System.beside([lane.system for lane in filled]), lanes[0].prepared.stepper.tolerance)
    state, slopes = State.beside([x.state for x in filled]), StateSlopes.beside([x.slopes for x in filled])
    columns = [type(each[0]).beside(each) for each in zip(*(lane.parameters for lane in filled), strict=True)]
    errors: list[SimulationError | None] = [None] * len(lanes)
    steps = max(map(len, lanes))
    drives, coefficients = _drives(filled, steps), _coefficients(filled, steps)
    by_contraction = np.stack([_lasting(lane.contraction_slopes, steps) for lane in filled], axis=-1)
    nodes = lanes[0].prepared.rows.nodes
    seen = Seen.of(nodes, steps + 1, state, slopes, keep_shapes)
    seen.note(0, nodes, state, slopes)
    ends = np.array([*map(len, lanes), *[0] * (count - len(lanes))])
    for step in range(steps):
        wanted = step < ends
        if not wanted.any():
            break
        part, found = stepper.step(state, drives[step], coefficients[step], wanted)
        after, slopes_after = part.after, slopes
        if columns:
            slopes_after = stepper.step_slopes(part, slopes, columns, by_contraction[step])
            if not found.all():
                slopes_after.put(~found, slopes, ~found)
        for index in np.flatnonzero(wanted & ~found):
            try:
                lanes[index].follow(stepper, step, index, after, slopes_after)  # type: ignore[call-overload]
            except SimulationError as error:
                errors[index], ends[index] = error, 0
        state, slopes = after, slopes_after
        seen.note(step + 1, nodes, state, slopes)
    return seen, errors


def _lasting(series: np.ndarray, steps: int) -> np.ndarray:
    """A series over the steps of one run, its last entry repeated to so many."""
    return series[np.minimum(np.arange(steps), len(series) - 1)]


def _drives(lanes: Sequence[Lane], steps: int) -> list[DriveState]:
    voltage, contraction, time = (
        np.stack(
            [_lasting(np.array([getattr(d, name)[..., 0] for d in lane.drives]), steps) for lane in lanes], -1
        )
        for name in ("voltage", "contraction", "time")
    )
    return [DriveState(*each) for each in zip(voltage, contraction, time, strict=True)]


def _coefficients(lanes: Sequence[Lane], steps: int) -> list[StepCoefficients]:
    """The coefficients of every step; equal steps share them."""
    known: dict[tuple[float, ...], StepCoefficients] = {}
    out = []
    for step in range(steps):
        each = [lane.plan.coefficients[min(step, len(lane) - 1)] for lane in lanes]
        lengths = tuple(c.step for c in each)
        if lengths not in known:
            known[lengths] = StepCoefficients.beside(each)
        out.append(known[lengths])
    return out
