# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is simulated, and what comes back."""

from dataclasses import dataclass

import numpy as np

from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.errors import SimulationError


@dataclass(frozen=True)
class Run:
    """One experiment: frames [s], what is commanded (None for a passive body) and how it starts.

    initial_state: "rest" (in equilibrium with all that acts on it undriven), "static_equilibrium" under
    initial_load_factor times all loads, or "held_shape", the nodal positions initial_shape [m] [nodes, 2] (such as
    one of `Simulation.shapes`); let go without speed at initial_time [s] (default: the first frame or switch,
    whichever comes first). Raises SimulationError for frames or a shape that are no numbers.
    """

    name: str
    time: np.ndarray
    schedule: DriveSchedule | None = None
    initial_state: str = "rest"
    initial_load_factor: float = 1.0
    initial_time: float | None = None
    initial_shape: np.ndarray | None = None

    def __post_init__(self) -> None:
        if len(self.time) == 0:
            raise SimulationError(f"run '{self.name}' has no frame; expected the time of at least one")
        broken = np.flatnonzero(~np.isfinite(self.time))
        if len(broken):
            raise SimulationError(
                f"frame {broken[0] + 1} of run '{self.name}' is at {self.time[broken[0]]} s; expected finite times: "
                "repair or remove that frame"
            )
        if self.initial_shape is not None and not np.isfinite(self.initial_shape).all():
            raise SimulationError(
                f"the shape in which run '{self.name}' starts has a node that is nowhere; expected finite positions: "
                "take it from a simulation with the same body"
            )

    @property
    def start(self) -> float:
        """When the body is let go [s]."""
        if self.initial_time is not None:
            return self.initial_time
        first = self.time[0]
        return float(first if self.schedule is None else min(first, self.schedule.time[0]))


@dataclass(frozen=True)
class Simulation:
    """A simulated run, sampled at the run's frames; NaN before the body is let go.

    sin_theta [n]; names and slopes [n, parameters]: derivatives of sin_theta; markers [m] [n, markers, 2]: head,
    middle, tail and the others in the model file's order; contraction [n, muscles]; shapes: nodal positions [m]
    [n, nodes, 2] where asked for, else None.
    """

    run: Run
    sin_theta: np.ndarray
    names: tuple[str, ...]
    slopes: np.ndarray
    markers: np.ndarray
    contraction: np.ndarray
    shapes: np.ndarray | None = None

    @property
    def time(self) -> np.ndarray:
        """The run's frames [s]."""
        return self.run.time

    @property
    def outputs(self) -> np.ndarray:
        """What is compared with measurements: sin theta alone, [n, outputs]."""
        return self.sin_theta[:, None]

    @property
    def output_slopes(self) -> np.ndarray:
        """Derivatives of the outputs, [n, outputs, parameters]."""
        return self.slopes[:, None, :]
