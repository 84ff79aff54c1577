"""Simulate runs with a model, with derivatives of the angle by any of its parameters."""

from collections.abc import Sequence

import numpy as np

from hasel_sim.build import Builder, difference_points, marker_points
from hasel_sim.drive.chain import DriveChain
from hasel_sim.drive.voltage import VoltageSchedule
from hasel_sim.effects.base import DriveEffect, EffectParameter, ObservationEffect
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.initial import initial_state
from hasel_sim.mechanics.residual_slopes import NoSlope, ResidualSlope
from hasel_sim.mechanics.stepper import Stepper
from hasel_sim.mechanics.steps import StepPlan, plan_steps
from hasel_sim.mechanics.system import DriveState
from hasel_sim.model import Model
from hasel_sim.observation import MarkerRows, observe
from hasel_sim.run import Run, Simulation

_REST = VoltageSchedule(np.zeros(1), np.zeros((1, 2)))


def simulate(model: Model, run: Run, slopes_by: Sequence[str] = (), keep_shapes: bool = False) -> Simulation:
    """Simulate one run.

    slopes_by: names of parameters by which sin theta is differentiated, exactly to the tolerance of the steps.
    Raises SimulationError when the motion cannot be followed, ModelError for an unknown parameter.
    """
    return _RunSimulation(model, run, tuple(slopes_by)).result(keep_shapes)


class _RunSimulation:
    def __init__(self, model: Model, run: Run, names: tuple[str, ...]) -> None:
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
        self.skipped = len(run.time) - len(frames)
        self.plan: StepPlan = plan_steps(
            frames, numerics.steps_per_second, numerics.spectral_radius, run.start, frames[-1] + ahead
        )
        builder = Builder(model)
        self.stepper = Stepper(builder.system(), numerics.tolerance_m)
        self.slopes = [builder.residual_slope(name) for name in names]
        fixed = model.description.markers
        self.rows = MarkerRows(
            builder.mesh,
            marker_points(model),
            np.array([fixed.head.fixed, fixed.middle.fixed, fixed.tail.fixed]),
        )
        self.schedule = run.schedule or _REST
        drive_effects = [e for e in model.effects if isinstance(e, DriveEffect)]
        self.chain = DriveChain(drive_effects, model.levels) if model.has_muscles else None

    def _contraction(self, times: np.ndarray, values: dict[str, float]) -> np.ndarray:
        if self.chain is None:
            return np.zeros((len(times), 2))
        every = np.concatenate([[min(self.run.start, times[0])], times])
        return self.chain.contraction(self.schedule, every, values, self.model.effect_values(values))[1:]

    def _contraction_slopes(self, times: np.ndarray) -> np.ndarray:
        """Derivative of the contraction by every parameter, [steps, columns, 2]."""
        out = np.zeros((len(times), len(self.names), 2))
        for column, parameter in enumerate(self.parameters):
            if not self._drives(parameter.name):
                continue
            more, less, width = difference_points(self._declared(parameter.name), parameter.value)
            above = self._contraction(times, {**self.model.values, parameter.name: more})
            below = self._contraction(times, {**self.model.values, parameter.name: less})
            out[:, column] = (above - below) / width
        return out

    def _drives(self, name: str) -> bool:
        identity = name.rpartition(".")[0]
        return not identity or any(
            isinstance(e, DriveEffect) and e.id == identity for e in self.model.effects
        )

    def _declared(self, name: str) -> EffectParameter:
        identity, _, own = name.rpartition(".")
        for effect in self.model.effects:
            if effect.id == identity:
                return next(p for p in effect.parameters if p.name == own)
        parameter = self.model.parameter(name)
        return EffectParameter(
            name, name, parameter.unit, 0.0, parameter.lower, parameter.upper, parameter.value or 0.1
        )

    def result(self, keep_shapes: bool) -> Simulation:
        """Integrate from the first step to the last and observe."""
        plan, stepper = self.plan, self.stepper
        contraction = self._contraction(plan.balance_times, self.model.values)
        contraction_slopes = self._contraction_slopes(plan.balance_times)
        moves = [n for n, slope in enumerate(self.slopes) if self._moves(slope, contraction_slopes[:, n])]
        contraction_slopes, moving = contraction_slopes[:, moves], [self.slopes[n] for n in moves]
        voltage = self.schedule.at(plan.balance_times)
        start = DriveState(np.zeros(2), np.zeros(2), self.run.start)
        load_factor = self.run.initial_load_factor if self.run.initial_state == "static_equilibrium" else 0.0
        shape = self.run.initial_shape if self.run.initial_state == "held_shape" else None
        state, slopes = initial_state(stepper.system, start, load_factor, moving, shape)
        where, across = [[part] for part in self.rows(state.position)]
        d_where, d_across = [[part] for part in self.rows.slopes(slopes.position)]
        shapes = [state.position]
        for step, c in enumerate(plan.coefficients):
            drive = DriveState(voltage[step], contraction[step], plan.balance_times[step])
            after, motion = stepper.step(state, drive, c)
            if moves:
                slopes = stepper.step_slopes(
                    state, after, motion, drive, c, slopes, moving, contraction_slopes[step]
                )
                for kept, new in zip((d_where, d_across), self.rows.slopes(slopes.position), strict=True):
                    kept.append(new)
            state = after
            for kept, new in zip((where, across), self.rows(state.position), strict=True):
                kept.append(new)
            if keep_shapes:
                shapes.append(state.position)
        markers, lines = np.array(where), np.array(across)
        series, derivatives = self._observed(markers, lines, np.array(d_where), np.array(d_across), moves)
        return Simulation(
            self.run,
            self._at_frames(series),
            self.names,
            self._at_frames(derivatives),
            self._at_frames(markers),
            self._at_frames(self._contraction(plan.boundaries, self.model.values)),
            self._at_frames(np.array(shapes)) if keep_shapes else None,
        )

    @staticmethod
    def _moves(slope: ResidualSlope, contraction_slope: np.ndarray) -> bool:
        """Whether a parameter moves the body at all in this run; columns that do not cost nothing."""
        return not isinstance(slope, NoSlope) or bool(np.any(contraction_slope))

    def _at_frames(self, series: np.ndarray) -> np.ndarray:
        chosen = series[self.plan.frames]
        missing = np.full((self.skipped, *chosen.shape[1:]), np.nan)
        return np.concatenate([missing, chosen])

    def _observed(
        self, markers, lines, d_markers, d_lines, moves: list[int]
    ) -> tuple[np.ndarray, np.ndarray]:
        """The measured series [boundaries] and its derivatives [boundaries, columns].

        d_markers, d_lines: derivatives by the parameters numbered in `moves`.
        """
        time, values = self.plan.boundaries, self.model.effect_values()
        series = observe(time, markers, lines, self.observed_by, values)
        derivatives = np.zeros((len(time), len(self.names)))
        for index, column in enumerate(moves):
            direction, across = d_markers[:, index], d_lines[:, index]
            step = 1e-6 / max(np.abs(direction).max(), 1e-12)
            above = observe(time, markers + step * direction, lines + step * across, self.observed_by, values)
            below = observe(time, markers - step * direction, lines - step * across, self.observed_by, values)
            derivatives[:, column] = (above - below) / (2 * step)
        for column, name in enumerate(self.names):
            if name.rpartition(".")[0] in {effect.id for effect in self.observed_by}:
                derivatives[:, column] += self._by_observation(name, time, markers, lines)
        return series, derivatives

    def _by_observation(self, name: str, time, markers, lines) -> np.ndarray:
        more, less, width = difference_points(self._declared(name), self.model.parameters[name].value)
        above, below = (
            observe(
                time,
                markers,
                lines,
                self.observed_by,
                self.model.effect_values({**self.model.values, name: value}),
            )
            for value in (more, less)
        )
        return (above - below) / width
