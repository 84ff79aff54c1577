"""Steps whose first guess fails."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.initial import initial_state
from hasel_sim.mechanics.motion import DriveState
from hasel_sim.mechanics.newton import Newton
from hasel_sim.mechanics.stepper import Stepper
from hasel_sim.mechanics.steps import plan_steps

PULLED = DriveState.single(np.array([5000.0, 0.0]), np.array([0.01, 0.0]), 0.0)
STEPS = plan_steps(np.arange(5) / 120, 120.0, 0.9, 0.0, 4 / 120).coefficients


class FailingNewton(Newton):
    """Finds the matrix singular at chosen calls, as a guess that turns an element inside out makes it."""

    def __init__(self, system, fails_at):
        super().__init__(system)
        self.calls, self.fails_at = 0, fails_at

    def correction(self, motion, fresh, expected):
        """Count the call, and fail if it is one of the chosen."""
        self.calls += 1
        if self.calls in self.fails_at:
            raise SimulationError("the tangent matrix is singular")
        return super().correction(motion, fresh, expected)


def run(swimmer, fails_at=()):
    """State after four steps with one muscle pulling, and how many corrections were asked for."""
    model = swimmer.with_numerics(mesh_density=0.5)
    stepper = Stepper(Builder(model).system(), 1e-8)
    stepper.newton = FailingNewton(stepper.system, fails_at)
    state, _ = initial_state(stepper.system, PULLED, 0.0, [])
    for c in STEPS:
        state = stepper.follow(state, PULLED, c)[-1].after
    return state, stepper.newton.calls


def test_a_guess_that_cannot_be_factorised_gives_way_to_the_next(swimmer):
    """The step is made all the same, from the second guess, and ends where it would have."""
    expected, calls = run(swimmer)
    state, _ = run(swimmer, fails_at=(calls,))
    assert state.position == pytest.approx(expected.position, abs=1e-9)


def test_a_step_without_a_guess_left_is_made_in_two(swimmer):
    """All three tries of the first step fail; half as long, it ends nearly where it would have."""
    expected, calls = run(swimmer)
    state, more = run(swimmer, fails_at=(1, 2, 3))
    assert more >= calls + 2
    assert state.position == pytest.approx(expected.position, abs=1e-5)


def test_where_the_smallest_part_fails_it_says_when_and_what_to_do(swimmer):
    """After the step and eight halves in turn, three tries each."""
    with pytest.raises(
        SimulationError, match=r"could not be followed beyond t = .* divided by 256; expected"
    ):
        run(swimmer, fails_at=range(1, 28))
