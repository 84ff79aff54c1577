# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A run made ready to be stepped through: its mesh, system, time steps, drive and how it is observed."""

import numpy as np

from hasel_sim.build import Builder, constant_parameter
from hasel_sim.drive.chain import DriveChain
from hasel_sim.drive.schedule import no_drive
from hasel_sim.dynamics.generalised_alpha import StepPlan, plan_steps
from hasel_sim.dynamics.integrator import Stepper
from hasel_sim.dynamics.statics import initial_state
from hasel_sim.effects.base import DriveEffect, EffectParameter, ObservationEffect
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.state import DriveState, State, StateSlopes
from hasel_sim.model import Model
from hasel_sim.model.model_parameters import constants, response_parameters
from hasel_sim.model_mesh import marker_rows
from hasel_sim.run import Run

_ROUND_OFF = np.sqrt(np.finfo(float).eps)
"""Difference step of an onset over the top of its range, since from 0 it passes through values of no size."""


class PreparedRun:
    """One run with one model; `names` are the parameters by which it will be differentiated.

    like: another run with this very model and these names, whose mesh and system it shares. Raises SimulationError for
    a run without frames after its start, ModelError for an unknown parameter.
    """

    def __init__(
        self, model: Model, run: Run, names: tuple[str, ...] = (), like: "PreparedRun | None" = None
    ) -> None:
        self.model, self.run, self.names = model, run, names
        self.parameters = [model.parameter(name) for name in names]
        numerics = model.description.numerics
        self.observed_by = sorted(
            (e for e in model.effects if isinstance(e, ObservationEffect)), key=lambda effect: effect.id
        )
        values = model.effect_values()
        ahead = max([0.0, *(e.look_ahead(values[e.id]) for e in self.observed_by)])
        frames = run.time[run.time >= run.start - 1e-9]
        if len(frames) == 0:
            raise SimulationError(
                f"run '{run.name}' has no frame after {run.start} s; expected initial_time_s within it"
            )
        if run.schedule is not None and frames[-1] <= run.start:
            raise SimulationError(
                f"run '{run.name}' is driven but has no frame after its start at {run.start:g} s; expected at least "
                "one more frame to see what the drive does"
            )
        self._skipped = len(run.time) - len(frames)
        self.plan: StepPlan = plan_steps(
            frames, numerics.steps_per_second, numerics.spectral_radius, run.start, frames[-1] + ahead
        )
        if like is None:
            self.builder = Builder(model)
            self.stepper = Stepper(self.builder.system(), numerics.tolerance_m)
            self.rows = marker_rows(model, self.builder.mesh)
            self.residual_slopes = [self.builder.residual_slope(name) for name in names]
            self._chain = DriveChain(model)
            self._starts: dict[tuple[float, float, tuple[int, ...]], tuple[State, StateSlopes]] = {}
        else:
            self.builder, self.stepper, self.rows = like.builder, like.stepper, like.rows
            self.residual_slopes, self._chain, self._starts = like.residual_slopes, like._chain, like._starts
        self.schedule = (run.schedule or no_drive(model.channels)).of(model.channels, run.name)

    @property
    def load_factor(self) -> float:
        """Share of all loads under which the body is in equilibrium when it starts."""
        return self.run.initial_load_factor if self.run.initial_state == "static_equilibrium" else 1.0

    @property
    def held_shape(self) -> np.ndarray | None:
        """Nodal positions [m] [nodes, 2] in which the body is held when it starts, if it is."""
        return self.run.initial_shape if self.run.initial_state == "held_shape" else None

    @property
    def start_drive(self) -> DriveState:
        """Nothing commanded, the muscles as contracted as they always are, at the start."""
        return DriveState.single(np.zeros(self.muscles), self._chain.relaxed, self.run.start)

    def start(self, moves: list[int]) -> tuple[State, StateSlopes]:
        """The first state and its derivatives by the parameters numbered in `moves`; runs alike share one."""
        drive, shape = self.start_drive, self.held_shape
        key = (self.load_factor, drive.time[0], tuple(moves))
        if shape is not None or key not in self._starts:
            slopes = [self.residual_slopes[column] for column in moves]
            found = initial_state(self.stepper.system, drive, self.load_factor, slopes, shape)
            if shape is not None:
                return found
            self._starts[key] = found
        return self._starts[key]

    @property
    def muscles(self) -> int:
        """How many muscles there are."""
        return self._chain.count

    def drives(self, contraction: np.ndarray) -> list[DriveState]:
        """The drive at the balance of every step, for contractions [steps, muscles]."""
        times = self.plan.balance_times
        return [DriveState.single(*row) for row in zip(self.voltage(times), contraction, times, strict=True)]

    def voltage(self, times: np.ndarray) -> np.ndarray:
        """What drives every muscle [n, muscles] at times [s] [n]."""
        return self._chain.at_muscles(self.schedule.at(times))

    def contraction(self, times: np.ndarray, values: dict[str, float] | None = None) -> np.ndarray:
        """Contraction [1] [n, muscles] at ascending times [s] [n], at the model's or other parameter values."""
        values = values or self.model.values
        every = np.concatenate([[min([self.run.start, *times[:1]])], times])
        return self._chain.contraction(self.schedule, every, values, self.model.effect_values(values))[1:]

    def contraction_slopes(self, times: np.ndarray) -> np.ndarray:
        """Derivative of the contraction by every named parameter, [steps, columns, muscles]."""
        out = np.zeros((len(times), len(self.names), self.muscles))
        for column, parameter in enumerate(self.parameters):
            if not self._drives(parameter.name):
                continue
            more, less, width = self.declared(parameter.name).around(parameter.value)
            above = self.contraction(times, {**self.model.values, parameter.name: more})
            below = self.contraction(times, {**self.model.values, parameter.name: less})
            out[:, column] = (above - below) / width
        return out

    def _drives(self, name: str) -> bool:
        identity = name.rpartition(".")[0]
        if any(isinstance(e, DriveEffect) and e.id == identity for e in self.model.effects):
            return True
        known = self.model.is_amplitude(name) or self.model.is_onset(name)
        return known or name in response_parameters(self.model.description)

    def declared(self, name: str) -> EffectParameter:
        """What the effect, or the baseline, says about a parameter."""
        identity, _, own = name.rpartition(".")
        for effect in self.model.effects:
            if effect.id == identity:
                return next(p for p in effect.parameters if p.name == own)
        parameter = self.model.parameter(name)
        if name in constants(self.model.description):
            return constant_parameter(self.model, name)
        magnitude = parameter.magnitude or 0.1
        step = max(1e-6 * magnitude, _ROUND_OFF * parameter.upper) if self.model.is_onset(name) else 0.0
        return EffectParameter(
            name, name, parameter.unit, 0.0, parameter.lower, parameter.upper, magnitude, difference=step
        )

    def at_frames(self, series: np.ndarray) -> np.ndarray:
        """A series over the step boundaries, at the run's frames; NaN before the start."""
        chosen = series[self.plan.frames]
        missing = np.full((self._skipped, *chosen.shape[1:]), np.nan)
        return np.concatenate([missing, chosen])
