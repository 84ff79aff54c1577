# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""How a free body swims: position, speed, heading, power and cost of transport of a simulated run."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.build import Builder
from hasel_sim.errors import SimulationError
from hasel_sim.model import Model
from hasel_sim.run import Run, Simulation
from hasel_sim.simulate import simulate

_LEAST_WINDOW = 1.0
"""Seconds, in whole periods, over which a settled speed is taken at least."""


@dataclass(frozen=True)
class FreeSwim:
    """What a swim of one drive came to.

    time [s] [n]; position: of the centre of mass [m] [n, 2]; turned: of the body since the start, to the left [rad]
    [n]; work: of the muscles since the start [J] [n]; all from the first frame on. speed: of the settled swim [m/s],
    forwards where positive, over the last whole periods; earlier: the same just before, which tells whether it has
    settled; turning [rad/s]; power: mean mechanical power of the muscles [W]; mass: of the body [kg].
    """

    time: np.ndarray
    position: np.ndarray
    turned: np.ndarray
    work: np.ndarray
    speed: float
    earlier: float
    turning: float
    power: float
    mass: float

    @property
    def distance(self) -> float:
        """From start to end [m]."""
        return float(np.linalg.norm(self.position[-1] - self.position[0]))

    @property
    def heading(self) -> float:
        """Where the body points at the end, from where it pointed at the start, to the left [rad]."""
        return float(self.turned[-1])

    def mean_heading(self, frequency: float) -> float:
        """The same as a mean over the last period of a drive [Hz], which its swinging has no part in [rad]."""
        ends = self.time[-1] - np.array([1 / frequency, 0.0])
        return float(_means(self.time, self.turned[:, None], ends, frequency)[1, 0])

    @property
    def cost_of_transport(self) -> float:
        """Work of the muscles per mass and distance [J/(kg m)]; infinite for a body that does not get forward."""
        return self.power / (self.mass * self.speed) if self.speed > 0 else np.inf

    def __str__(self) -> str:
        return (
            f"{1e3 * self.distance:.1f} mm in {self.time[-1] - self.time[0]:.3g} s, at the end "
            f"{1e3 * self.speed:.2f} mm/s and {np.degrees(self.turning):+.2f}°/s with {1e3 * self.power:.3g} mW, "
            f"{self.cost_of_transport:.3g} J/(kg m)."
        )


def free_swim(model: Model, run: Run, frequency: float) -> FreeSwim:
    """Simulate a run and measure how the body swims. Raises what `check_swimmer` and `simulate` raise."""
    check_swimmer(model)
    return measured(model, simulate(model, run, keep_shapes=True), frequency)


def check_swimmer(model: Model) -> None:
    """Refuse a body that is clamped or has no fluid to push, with a SimulationError."""
    if model.description.body.clamped:
        raise SimulationError(
            f"model '{model.name}' is clamped; expected a free body: remove body.clamped from its file"
        )
    if model.description.surroundings is None:
        raise SimulationError(
            f"model '{model.name}' names no fluid; expected a section medium and effects of it, as in the model "
            "swimmer_in_oil: add them"
        )
    if not any(effect.needs_medium for effect in model.effects):
        raise SimulationError(
            f"model '{model.name}' has no effect of its fluid, so nothing pushes it; expected some such as "
            "normal_drag, skin_friction and reactive_force: add them"
        )


def measured(model: Model, simulation: Simulation, frequency: float) -> FreeSwim:
    """What a simulation with shapes tells of a swim driven at a frequency [Hz]."""
    if simulation.shapes is None:
        raise SimulationError("a swim is measured on its shapes; expected keep_shapes=True: simulate with it")
    builder, depth = Builder(model), model.described.body.depth_m or 0.0
    nodal = nodal_masses(builder)
    mass, time = float(nodal.sum()), simulation.time
    position = np.einsum("n,tnd->td", nodal, simulation.shapes) / mass
    turned = _turned(
        simulation.shapes - position[:, None], builder.nodes - nodal @ builder.nodes / mass, nodal
    )
    work = depth * _work(builder, simulation)
    periods = max(2, int(np.ceil(_LEAST_WINDOW * frequency)))
    periods = min(periods, int((time[-1] - time[0]) * frequency / 2))
    ends = time[-1] - np.array([2 * periods, periods, 0]) / frequency
    early, late = (
        _forward(time, position, turned, start, end, frequency)
        for start, end in ((ends[0], ends[1]), (ends[1], ends[2]))
    )
    window = ends[2] - ends[1]
    headings = _means(time, turned[:, None], ends[1:], frequency)[:, 0]
    turning = float(np.diff(headings)[0] / (window - 1 / frequency))
    power = float(np.diff(np.interp(ends[1:], time, work))[0] / window)
    return FreeSwim(time, position, turned, work, late, early, turning, power, mass * depth)


def _turned(arms: np.ndarray, rest: np.ndarray, nodal: np.ndarray) -> np.ndarray:
    """Rotation [rad] [n] that takes the body at rest [nodes, 2] nearest to where it is [n, nodes, 2]."""
    cross = rest[:, 0] * arms[..., 1] - rest[:, 1] * arms[..., 0]
    return np.unwrap(np.arctan2(cross @ nodal, np.einsum("tnd,nd,n->t", arms, rest, nodal)))


def _means(time: np.ndarray, series: np.ndarray, ends: np.ndarray, frequency: float) -> np.ndarray:
    """Means [2, k] of a series [n, k] over the first and the last period between two times."""
    steps = 0.5 * (series[1:] + series[:-1]) * np.diff(time)[:, None]
    integral = np.concatenate([np.zeros((1, series.shape[1])), np.cumsum(steps, axis=0)])
    starts = np.array([ends[0], ends[1] - 1 / frequency])
    parts = [
        np.interp(starts + 1 / frequency, time, column) - np.interp(starts, time, column)
        for column in integral.T
    ]
    return frequency * np.stack(parts, axis=1)


def _forward(
    time: np.ndarray, position: np.ndarray, turned: np.ndarray, start: float, end: float, frequency: float
) -> float:
    """Mean speed [m/s] along the body's heading between two times, from means over whole periods."""
    periods = round((end - start) * frequency)
    bounds = start + np.arange(periods + 1) / frequency
    middles = [
        _means(time, np.column_stack([position, turned]), bounds[[k, k + 1]], frequency)[0]
        for k in range(periods)
    ]
    x, y, turn = np.array(middles).T
    ahead = 0.5 * (turn[1:] + turn[:-1])
    gained = -(np.diff(x) * np.cos(ahead) + np.diff(y) * np.sin(ahead))
    return float(gained.sum() * frequency / (periods - 1))


def nodal_masses(builder: Builder) -> np.ndarray:
    """Mass per depth that goes with each node [kg/m] [nodes]."""
    return builder.mass.product(np.ones((1, *builder.nodes.shape, 1)))[0, :, 0, 0]


def muscle_fibres(builder: Builder) -> list[tuple[np.ndarray, np.ndarray, np.ndarray, float]]:
    """Of every muscle: nodes of its elements [elements, 8], gradients along its fibres [1/m] [elements, points, 8],
    volumes per depth [m^2] [elements, points] and stiffness [Pa].
    """
    mesh, solid, out = builder.mesh, builder.system().solid, []
    for number, muscle in enumerate(builder.model.described.muscles, start=1):
        within = mesh.muscle == number
        stretch = solid.stretch[within, :, 0]
        along = solid.gradients[within, :, :, 0] / stretch[..., None]
        out.append((mesh.elements[within], along, solid.areas[within] * stretch, muscle.fibre_stiffness_pa))
    return out


def _work(builder: Builder, simulation: Simulation) -> np.ndarray:
    """Work of the muscles per depth since the start [J/m] [n]: their fibres' tension along what they contract."""
    contraction, total = simulation.contraction, np.zeros(len(simulation.time))
    for number, (nodes, along, volume, stiffness) in enumerate(muscle_fibres(builder)):
        fibre = np.einsum("epk,tekd->dtep", along, np.asarray(simulation.shapes)[:, nodes])
        excess = np.hypot(*fibre) - (1.0 - contraction[:, number, None, None])
        pull = stiffness * (excess * volume).sum(axis=(1, 2))
        total[1:] += np.cumsum(0.5 * (pull[1:] + pull[:-1]) * np.diff(contraction[:, number]))
    return total
