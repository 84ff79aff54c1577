"""Steps whose first guess fails."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.initial import initial_state
from hasel_sim.mechanics.motion import DriveState
from hasel_sim.mechanics.stepper import Stepper
from hasel_sim.mechanics.steps import plan_steps

PULLED = DriveState(np.array([5000.0, 0.0]), np.array([0.01, 0.0]), 0.0)
STEPS = plan_steps(np.arange(5) / 120, 120.0, 0.9, 0.0, 4 / 120).coefficients


class FailingStepper(Stepper):
    """Finds the matrix singular at chosen calls, as a guess that turns an element inside out makes it."""

    def __init__(self, system, fails_at):
        super().__init__(system, 1e-8)
        self.calls, self.fails_at = 0, fails_at

    def factorise(self, line, c):
        """Count the call, and fail if it is one of the chosen."""
        self.calls += 1
        if self.calls in self.fails_at:
            raise SimulationError("the tangent matrix is singular")
        return super().factorise(line, c)


def run(swimmer, fails_at=()):
    """State after four steps with one muscle pulling, and how often a matrix was factorised."""
    model = swimmer.with_numerics(mesh_density=0.5)
    stepper = FailingStepper(Builder(model).system(), fails_at)
    state, _ = initial_state(stepper.system, PULLED, 0.0, [])
    for c in STEPS:
        state, _ = stepper.step(state, PULLED, c)
    return state, stepper.calls


def test_a_guess_that_cannot_be_factorised_gives_way_to_the_next(swimmer):
    """The step is made all the same, from the second guess, and ends where it would have."""
    expected, calls = run(swimmer)
    state, _ = run(swimmer, fails_at=(calls,))
    assert state.position == pytest.approx(expected.position, abs=1e-9)


def test_without_a_guess_left_it_says_when_and_what_to_do(swimmer):
    """The first step has one guess only."""
    with pytest.raises(SimulationError, match="could not be followed beyond"):
        run(swimmer, fails_at=(1,))
