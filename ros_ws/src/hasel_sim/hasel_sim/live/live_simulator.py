# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A simulation that is fed with the supply's state as it comes in: its model, the order of the messages, the motion."""

from dataclasses import dataclass
from enum import Enum
from pathlib import Path

import numpy as np
from hasel_common.inside_folder import inside_folder

from hasel_sim.build import Builder
from hasel_sim.drive.schedule import HASEL_CHANNELS
from hasel_sim.dynamics.generalised_alpha import StepPlan, plan_steps
from hasel_sim.dynamics.integrator import Stepper
from hasel_sim.dynamics.statics import initial_state
from hasel_sim.errors import ModelError, SimulationError
from hasel_sim.live.histories import AngleHistory, DriveHistory
from hasel_sim.mechanics.state import DriveState, State
from hasel_sim.mesh.mesh import Mesh
from hasel_sim.model import Model, load_model
from hasel_sim.model_mesh import marker_rows


def within(folder: str, name: str) -> str:
    """`name` of a model or an effect, where it is no file or one below `folder`. Raises ModelError for any other."""
    path, colon, kind = name.partition(":")
    if not colon and not Path(name).suffix and "/" not in name:
        return name
    if not folder:
        raise ModelError(
            f"'{name}' is a file, and a request may name the catalogue's only: start the node with own_files set to the"
            " folder in which yours are"
        )
    try:
        return f"{inside_folder(folder, path)}{colon}{kind}"
    except ValueError as error:
        raise ModelError(f"{error}: name one there; the folder was given as own_files") from None


_LEVEL_WITHOUT_FIT = 5500.0


def live_model(name: str, effects: tuple[str, ...] = ()) -> tuple[Model, str]:
    """A model by name or file, with further effects, and a warning (else empty).

    A model with muscles that was never fitted has no amplitudes: it gets one, so that it moves. Raises ModelError, also
    for a body that is driven by something else than the rig's voltages.
    """
    model, warning = load_model(name), ""
    rig_columns(model)
    if model.has_muscles and len(model.levels) == 0 and model.description.muscle is None:
        model = model.with_levels(np.array([_LEVEL_WITHOUT_FIT]))
        start = model.parameters[f"amplitude_{_LEVEL_WITHOUT_FIT:g}"].value
        warning = (
            f"model '{name}' was never fitted: its contraction is taken as {start:g} at {_LEVEL_WITHOUT_FIT:g} V, "
            "in proportion to the voltage; fit it, or load a fitted model file"
        )
    return model.with_effects(*effects), warning


def rig_columns(model: Model) -> list[int]:
    """Which of the supply's two voltages drives each channel. Raises ModelError where a channel is not one of them."""
    for channel in model.description.channels:
        if channel.quantity != "voltage" or channel.name not in HASEL_CHANNELS:
            raise ModelError(
                f"model '{model.name}' is driven by the {channel.quantity} '{channel.name}', and the supply reports "
                f"the voltages {' and '.join(HASEL_CHANNELS)} only: simulate its recordings with compare, or choose "
                "a model with these channels"
            )
    return [HASEL_CHANNELS.index(name) for name in model.channels]


class Arrival(Enum):
    """What a message's stamp means for the simulation."""

    START = "start"
    NEXT = "next"
    GAP = "gap"
    HELD = "held"
    RESTART = "restart"


@dataclass(frozen=True)
class StampVerdict:
    """What to do with a message, and a sentence when that is out of the ordinary (else empty)."""

    arrival: Arrival
    sentence: str = ""


class StampOrder:
    """Compares each stamp [ns] with the newest one accepted.

    gap: messages further apart [s] than this count as missing; the body moves on under the voltage held.
    reset: a longer gap [s] begins a new run; late: so does a message older than the newest by more than this [s].
    """

    def __init__(self, gap: float, reset: float, late: float) -> None:
        self.gap, self.reset, self.late = gap, reset, late
        self._newest: int | None = None

    def forget(self) -> None:
        """Let the next message begin a new run."""
        self._newest = None

    def judge(self, stamp_ns: int) -> StampVerdict:
        """Accept a stamp, or hold on to the newest one."""
        newest = self._newest
        if newest is None:
            self._newest = stamp_ns
            return StampVerdict(Arrival.START)
        step = (stamp_ns - newest) * 1e-9
        if not -self.late <= step <= self.reset:
            self._newest = stamp_ns
            return StampVerdict(
                Arrival.RESTART, f"the stamps jumped by {step:+.3g} s: a new run starts from rest"
            )
        if step <= 0:
            what = "came twice" if step == 0 else f"is {-step:.3g} s older than the newest"
            return StampVerdict(Arrival.HELD, f"a state message {what}: it is ignored and the body held")
        self._newest = stamp_ns
        if step > self.gap:
            return StampVerdict(
                Arrival.GAP,
                f"no state message for {step:.3g} s, expected one every {self.gap:g} s: the last voltage was held",
            )
        return StampVerdict(Arrival.NEXT)


_SHORTEST = 1e-3
"""Of a usual step: the body is not moved on by less, since in so short a time nothing but rounding accelerates it."""


@dataclass(frozen=True)
class LiveAngle:
    """The simulated sine of the bending angle at a state message's stamp [ns]."""

    stamp_ns: int
    sin_theta: float


@dataclass(frozen=True)
class LiveAnswer:
    """What one state message led to; `sentence` tells what was out of the ordinary (else empty)."""

    arrival: Arrival
    angles: tuple[LiveAngle, ...] = ()
    simulated: float = 0.0
    """Time [s] by which the body was moved on."""
    sentence: str = ""


class LiveSimulator:
    """Moves the body on to the stamp of every state message, under the voltage that held until then.

    history: how far back [s] drive and observation effects remember; gap, reset, late: see `StampOrder`;
    load_factor: a run starts in equilibrium under this many times all loads, 0: unloaded.
    The angles agree with those of `simulate` on the same schedule. A body that has not moved for `history` under a
    drive that has not changed is at rest: it is not stepped until the drive changes.
    """

    def __init__(
        self,
        model: Model,
        history: float = 20.0,
        gap: float = 0.1,
        reset: float = 2.0,
        late: float = 0.5,
        load_factor: float = 1.0,
    ) -> None:
        self.history, self.load_factor = history, load_factor
        self.order = StampOrder(gap, reset, late)
        self._state: State | None = None
        self._build(model)

    @property
    def mesh(self) -> Mesh:
        """The body's mesh."""
        return self._stepper.system.mesh

    @property
    def position(self) -> np.ndarray:
        """Nodal positions [m] [nodes, 2] now; the reference shape before the first message."""
        return self.mesh.nodes if self._state is None else self._state.position[..., 0]

    @property
    def markers(self) -> np.ndarray:
        """Positions [m] of all markers now, [markers, 2]."""
        return self._rows(self.position)[0]

    def receive(self, stamp_ns: int, voltage: np.ndarray) -> LiveAnswer:
        """Move on to a state message's stamp [ns]; its voltage [V] of upper and lower channel holds from there on.

        A message out of order changes nothing; a voltage that is not known (NaN) leaves the last one in force, 0 V at
        the start of a run. When the motion cannot be followed, the next message starts from rest.
        """
        verdict = self.order.judge(stamp_ns)
        if verdict.arrival == Arrival.HELD:
            return LiveAnswer(verdict.arrival, sentence=verdict.sentence)
        try:
            if verdict.arrival in (Arrival.START, Arrival.RESTART):
                self._start(stamp_ns)
            simulated = self._move_to(stamp_ns)
        except SimulationError as error:
            self.restart()
            return LiveAnswer(verdict.arrival, sentence=f"{error}; the next state message starts from rest")
        sentence = verdict.sentence
        if np.all(np.isfinite(voltage)):
            self._drive.hold(self._time, np.asarray(voltage, dtype=float)[self._columns])
        else:
            sentence = (
                sentence
                or "the supply does not know its voltage: the last one is held (0 V before any is known)"
            )
        angles = tuple(LiveAngle(stamp, sine) for stamp, sine in self._angles.ready())
        return LiveAnswer(verdict.arrival, angles, simulated, sentence)

    def restart(self) -> None:
        """Let the next message start a run from rest."""
        self.order.forget()
        self._state = None

    def use(self, model: Model) -> None:
        """Go on with another model: in the present motion when the body is the same, from rest otherwise.

        Raises ModelError for a model that cannot be built; the present one then stays.
        """
        before = self.mesh
        self._build(model)
        if self._state is None or self.mesh is not before:
            self.restart()
            return
        self._drive.use(model)
        self._angles.use(model)
        self._moved()
        _fit_branches(self._state, self._stepper)

    def _build(self, model: Model) -> None:
        builder = Builder(model)
        rows = marker_rows(model, builder.mesh)
        stepper = Stepper(builder.system(), model.description.numerics.tolerance_m)
        self.model, self._rows, self._stepper = model, rows, stepper
        self._columns = rig_columns(model)

    def _start(self, stamp_ns: int) -> None:
        self._origin_ns, self._time = stamp_ns, 0.0
        self._stepper = Stepper(self._stepper.system, self._stepper.tolerance)
        self._drive = DriveHistory(self.model, self.history, 0.0)
        self._state, _ = initial_state(self._stepper.system, self._drive.still, self.load_factor, [])
        self._stepper.start(self._state, self._drive.still)
        self._angles = AngleHistory(self.model, self.history)
        self._moved()
        self._see(np.zeros(1), [self.position])

    def _move_to(self, stamp_ns: int) -> float:
        """Step to a stamp [ns] and return by how much [s]."""
        time, numerics = (stamp_ns - self._origin_ns) * 1e-9, self.model.description.numerics
        step = time - self._time
        if step > _SHORTEST / numerics.steps_per_second:
            plan = plan_steps(
                np.array([time]), numerics.steps_per_second, numerics.spectral_radius, self._time, time
            )
            if self._is_at_rest():
                self._drive.wait(plan.balance_times)
                positions = [self.position] * len(plan.balance_times)
            else:
                positions = self._steps(plan)
            self._see(plan.boundaries[1:], positions)
            self._time = time
        self._angles.expect(stamp_ns, self._time)
        return step

    def _steps(self, plan: StepPlan) -> list[np.ndarray]:
        """Make the steps of a plan; the positions [m] after each."""
        voltage, contraction = self._drive.advance(plan.balance_times)
        positions = []
        for index, coefficients in enumerate(plan.coefficients):
            drive = DriveState.single(voltage[index], contraction[index], plan.balance_times[index])
            self._state = self._stepper.follow(self._state, drive, coefficients)[-1].after
            positions.append(self.position)
        if np.abs(self.position - self._still).max() > self._stepper.tolerance:
            self._moved()
        return positions

    def _moved(self) -> None:
        self._still, self._still_since = self.position.copy(), self._time

    def _is_at_rest(self) -> bool:
        return self._time - max(self._still_since, self._drive.changed_at) > self.history

    def _see(self, times: np.ndarray, positions: list[np.ndarray]) -> None:
        self._angles.add(times, *self._rows(np.array(positions)))


def _fit_branches(state: State, stepper: Stepper) -> None:
    """Give a moving body the internal branches of another material, relaxed as of now."""
    solid = stepper.system.solid
    count = len(solid.branches)
    if count == (0 if state.branch is None else len(state.branch)):
        return
    state.branch = np.zeros((count, *solid.areas.shape, 3, 1)) if count else None
    state.green = solid.green_stress(solid.gradient(state.position)) if count else None
