# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Find the outline that bends most under a given drive, with no more material and no higher than before.

The six coefficients of the outline are free; the body keeps its area, stays below the default's largest height and
above 1.5 mm everywhere. The gradient by all coefficients comes from one adjoint sweep.

    python optimise_outline.py
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from hasel_sim.adjoint import DifferentiableRun
from hasel_sim.drive.schedule import DriveSchedule
from hasel_sim.model import load_model
from hasel_sim.run import Run
from scipy.optimize import minimize

FREQUENCY = 1.0
LOWEST = 0.2
"""Smallest half height, in largest half heights."""


@dataclass(frozen=True)
class BestOutline:
    """coefficients: of the outline; angle: root mean square of sin theta, before and after."""

    coefficients: np.ndarray
    angle_before: float
    angle_after: float
    evaluations: int

    def __str__(self) -> str:
        numbers = ", ".join(f"{c:.3f}" for c in self.coefficients)
        return (
            f"The rms of sin theta rises from {self.angle_before:.4f} to {self.angle_after:.4f} in {self.evaluations} "
            f"gradients with outline_coefficients: [{numbers}]."
        )


def constraints(start: np.ndarray) -> list[dict[str, Any]]:
    """Area kept, nowhere higher than the start, nowhere lower than LOWEST; all linear in the coefficients."""
    powers = np.arange(len(start))
    rows = np.linspace(0, 1, 41)[:, None] ** powers
    area, highest = 1.0 / (powers + 1), (rows @ start).max()
    return [
        {"type": "eq", "fun": lambda c: area @ (c - start), "jac": lambda c: area},
        {"type": "ineq", "fun": lambda c: rows @ c - LOWEST * highest, "jac": lambda c: rows},
        {"type": "ineq", "fun": lambda c: highest - rows @ c, "jac": lambda c: -rows},
    ]


def optimise(iterations: int = 12) -> BestOutline:
    """Maximise the rms of sin theta over one period of alternating boxes."""
    model = load_model("swimmer").with_levels(np.array([5500.0])).with_numerics(mesh_density=0.5)
    model = model.with_values({"amplitude_5500": 0.0624, "slope": 0.264})
    switches = np.array([0.0, 0.5 / FREQUENCY])
    voltage = DriveSchedule(switches, np.array([[5500.0, 0.0], [0.0, 5500.0]]))
    run = DifferentiableRun(model, Run("outline", np.arange(121) / 120 / FREQUENCY, voltage))
    start = run.outline().numpy()

    def loss(coefficients: np.ndarray) -> tuple[float, np.ndarray]:
        outline = torch.tensor(coefficients, requires_grad=True)
        angle = run.angle(outline=outline).square().mean().sqrt()
        (-angle).backward()
        return -angle.item(), outline.grad.numpy()

    found = minimize(
        loss,
        start,
        jac=True,
        method="SLSQP",
        constraints=constraints(start),
        options={"maxiter": iterations, "ftol": 1e-5},
    )
    return BestOutline(found.x, -loss(start)[0], -float(found.fun), int(found.nfev))


if __name__ == "__main__":
    print(optimise())
