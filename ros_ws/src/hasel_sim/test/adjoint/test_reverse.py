# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Back through one step, against the matrices of that step written out."""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sim.adjoint.gradient import follow
from hasel_sim.adjoint.reverse import StepBack
from hasel_sim.dynamics.system import DeformedSystem, linearise
from hasel_sim.errors import SimulationError
from hasel_sim.model import load_model
from hasel_sim.prepared_run import PreparedRun
from hasel_sim.run import Run


@pytest.fixture
def part():
    """A step of a clamped beam that was let go, with drag and a creep, and the system that made it."""
    model = load_model("beam").with_effects("quadratic_drag", "viscoelastic_creep")
    typical = {f"{e.id}.{p.name}": p.typical for e in model.effects for p in e.parameters}
    run = Run("let go", np.arange(0.0, 0.1, 1 / 60), None, "static_equilibrium", 1.4)
    prepared = PreparedRun(model.with_values(typical), run)
    trajectory = follow(prepared, prepared.contraction(prepared.plan.balance_times))
    return prepared.stepper.system, trajectory.steps[12][0]


def test_the_way_back_is_that_of_the_matrices_and_ends_where_the_body_is_held(part):
    """Multiplier and all three products agree; what is held has no derivatives, which would grow from step to step."""
    system, step = part
    reached, c = np.random.default_rng(1).normal(size=step.motion.position.shape), step.coefficients
    at = DeformedSystem(system, step.motion)
    multiplier, pulled = StepBack(system).pull(step, at, reached)
    line = linearise(system, step.motion, step.drive, system.memory(step.before, c.at))
    matrix = line.matrix(c.position, c.velocity, c.acceleration).factorise()
    solved = -matrix.solve(reached[None], transposed=True)[0]
    assert system.held > 0
    for found, expected in zip((multiplier, *pulled), (solved, *line.pulled_back(multiplier)), strict=True):
        assert np.abs(found - expected).max() <= 1e-8 * np.abs(expected).max()
        assert not found[: system.held].any()


def test_a_singular_step_is_said(part):
    """A matrix of nothing has no factors."""
    system, step = part
    nothing = replace(step.coefficients, position=0.0, velocity=0.0, acceleration=0.0)
    with pytest.raises(SimulationError, match="singular"):
        StepBack(system).pull(
            replace(step, coefficients=nothing), DeformedSystem(system, step.motion), step.motion.position
        )
