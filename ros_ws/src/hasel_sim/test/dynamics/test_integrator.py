# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Steps whose first guess fails."""

import numpy as np
import pytest
from hasel_sim.build import Builder
from hasel_sim.dynamics.generalised_alpha import plan_steps
from hasel_sim.dynamics.integrator import Integrator, Stepper
from hasel_sim.dynamics.statics import initial_state
from hasel_sim.errors import SimulationError
from hasel_sim.mechanics.state import DriveState
from hasel_sim.simulate import simulate

PULLED = DriveState.single(np.array([5000.0, 0.0]), np.array([0.01, 0.0]), 0.0)
STEPS = plan_steps(np.arange(5) / 120, 120.0, 0.9, 0.0, 4 / 120).coefficients


class FailingIntegrator(Integrator):
    """Does not find the balance at chosen tries, as a guess that turns an element inside out makes it."""

    def __init__(self, system, tolerance, fails_at):
        super().__init__(system, tolerance)
        self.tries, self.fails_at = 0, fails_at

    def advance_with_one_matrix(self, first, last):
        """Count the try, and leave everything as it is if it is one of the chosen."""
        self.tries += 1
        self.arrived[:] = False
        return first if self.tries in self.fails_at else super().advance_with_one_matrix(first, last)

    def try_again(self, step):
        """With a matrix for every correction, likewise."""
        self.tries += 1
        return self.tries not in self.fails_at and super().try_again(step)


def run(swimmer, fails_at=()):
    """State after four steps with one muscle pulling, and how many tries it took."""
    model = swimmer.with_numerics(mesh_density=0.5)
    stepper = Stepper(Builder(model).system(), 1e-8)
    stepper.integrator = FailingIntegrator(stepper.system, stepper.tolerance, fails_at)
    state, _ = initial_state(stepper.system, PULLED, 0.0, [])
    for c in STEPS:
        state = stepper.follow(state, PULLED, c)[-1].after
    return state, stepper.integrator.tries


def test_a_step_that_one_matrix_does_not_find_is_made_with_more(swimmer):
    """The step is made all the same, and ends where it would have."""
    expected, tries = run(swimmer)
    state, more = run(swimmer, fails_at=(tries,))
    assert more == tries + 1
    assert state.position == pytest.approx(expected.position, abs=1e-9)


def test_long_steps_are_seldom_made_anew(swimmer, boxes, monkeypatch):
    """One slow correction after a fast one is no reason for a matrix of every correction's own."""
    tries = []
    again = Integrator.try_again
    monkeypatch.setattr(Integrator, "try_again", lambda self, step: tries.append(step) or again(self, step))
    model = swimmer.with_numerics(mesh_density=0.7, quadrature_order=2, steps_per_second=120)
    simulate(model, boxes(duration=2.0))
    assert len(tries) < 0.4 * 240


def test_a_step_that_is_not_found_is_made_in_two(swimmer):
    """Both tries of the first step fail; half as long, it ends nearly where it would have."""
    expected, tries = run(swimmer)
    state, more = run(swimmer, fails_at=(1, 2))
    assert more == tries + 3
    assert state.position == pytest.approx(expected.position, abs=1e-5)


def test_a_matrix_that_is_singular_fails_the_try_and_leaves_no_trace(swimmer):
    """No number gets from one step into the next: made anew, it ends where it would have."""
    model = swimmer.with_numerics(mesh_density=0.5)
    stepper, fresh = (Stepper(Builder(model).system(), 1e-8) for _ in range(2))
    state, _ = initial_state(stepper.system, PULLED, 0.0, [])
    inside_out = state.copy()
    inside_out.position[..., 0, :] *= -1.0
    inside_out.velocity[:] = np.nan
    assert stepper.step(inside_out, PULLED, STEPS[0]) is None
    stepper.start(state, PULLED)
    fresh.start(state, PULLED)
    found, expected = (each.step(state, PULLED, STEPS[0]) for each in (stepper, fresh))
    assert np.array_equal(found.after.position, expected.after.position)


def test_where_the_smallest_part_fails_it_says_when_and_what_to_do(swimmer):
    """After the step and eight halves in turn, two tries each."""
    with pytest.raises(
        SimulationError, match=r"could not be followed beyond t = .* divided by 256; expected"
    ):
        run(swimmer, fails_at=range(1, 19))
