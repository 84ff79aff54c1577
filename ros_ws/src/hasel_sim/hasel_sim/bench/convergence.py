# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Convergence of the swimmer's angle under refinement of mesh and time step, and what a fit to measurements prefers."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from rich.console import Console
from rich.table import Table

from hasel_sim.bench.cases import box_run, fitted_swimmer, node_count, table_of
from hasel_sim.simulate import simulate

DENSITIES = (0.5, 0.7, 1.0, 1.5, 2.0)
FINEST = {"mesh_density": 6.0, "layers": 2}
"""2 267 nodes; 3 019 differ from them by 0.00001, 1 515 by 0.00004."""
STEPS_PER_SECOND = (120.0, 240.0, 480.0, 960.0)


@dataclass(frozen=True)
class MeshError:
    """Mean |difference of sin theta| from the finest mesh at 5.5 kV, 2 Hz."""

    quadrature_order: int
    mesh_density: float
    nodes: int
    error: float


@dataclass(frozen=True)
class StepError:
    """Mean |difference of sin theta| from 1920 steps a second on the default mesh."""

    steps_per_second: float
    error: float


def mesh_errors() -> list[MeshError]:
    """Errors of both quadratures on all meshes."""
    model, run = fitted_swimmer(), box_run()
    finest = simulate(model.with_numerics(**FINEST), run).sin_theta
    out = []
    for order in (3, 2):
        for density in DENSITIES:
            refined = model.with_numerics(mesh_density=density, quadrature_order=order)
            error = np.abs(simulate(refined, run).sin_theta - finest).mean()
            out.append(MeshError(order, density, node_count(refined), float(error)))
    return out


def step_errors() -> list[StepError]:
    """Errors of the time step on the default mesh."""
    model, run = fitted_swimmer(), box_run()
    finest = simulate(model.with_numerics(steps_per_second=1920.0), run).sin_theta
    refined = [model.with_numerics(steps_per_second=rate) for rate in STEPS_PER_SECOND]
    errors = [float(np.abs(simulate(one, run).sin_theta - finest).mean()) for one in refined]
    return [StepError(rate, error) for rate, error in zip(STEPS_PER_SECOND, errors, strict=True)]


@dataclass(frozen=True)
class ConvergenceReport:
    """Errors of mesh and time step."""

    meshes: list[MeshError]
    steps: list[StepError]

    def values(self) -> dict[str, Any]:
        """Everything as plain values, for JSON."""
        return asdict(self)

    def print(self, console: Console) -> None:
        """Print the tables."""
        meshes = table_of(
            "Mean |difference of sin theta| from the finest mesh, 5.5 kV, 2 Hz",
            ("quadrature", "mesh density", "nodes", "error"),
            [
                (
                    f"{mesh.quadrature_order} x {mesh.quadrature_order}",
                    f"{mesh.mesh_density:g}",
                    str(mesh.nodes),
                    f"{mesh.error:.4f}",
                )
                for mesh in self.meshes
            ],
        )
        steps = Table("steps/s", "error", title="The same, from 1920 steps a second on the default mesh")
        for step in self.steps:
            steps.add_row(f"{step.steps_per_second:g}", f"{step.error:.5f}")
        console.print(meshes, steps)
