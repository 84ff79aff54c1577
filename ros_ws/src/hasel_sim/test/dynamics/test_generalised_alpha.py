# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The plan of time steps between frames."""

import numpy as np
import pytest
from hasel_sim.dynamics.generalised_alpha import plan_steps, step_coefficients


def test_every_frame_is_a_step_boundary():
    """Uneven frames, a start before the first and an end after the last."""
    frames = np.array([0.05, 0.0583, 0.09, 0.1])
    plan = plan_steps(frames, 240.0, 0.9, 0.0, 0.12)
    assert plan.boundaries[plan.frames] == pytest.approx(frames)
    assert (plan.boundaries[0], plan.boundaries[-1]) == (0.0, 0.12)
    assert np.diff(plan.boundaries).max() <= 1.01 / 240
    assert [c.step for c in plan.coefficients] == pytest.approx(np.diff(plan.boundaries), abs=1e-9)


def test_frames_of_a_camera_share_two_steps_each():
    """120 frames a second at 240 steps a second, whatever the rounding of the frame times."""
    frames = np.round(np.arange(241) / 120, 4)
    plan = plan_steps(frames, 240.0, 0.9, 0.0, frames[-1])
    assert len(plan.coefficients) == 480


def test_forces_balance_within_the_step():
    """The instant of balance is the step's start plus (1 - alpha_f) of its length."""
    plan = plan_steps(np.array([0.0, 0.1]), 10.0, 0.9, 0.0, 0.1)
    assert plan.balance_times == pytest.approx([0.1 * (1 - 0.9 / 1.9)])


@pytest.mark.parametrize("rho", [0.5, 0.9, 1.0])
def test_the_method_is_second_order_and_damps_as_rho_says(rho):
    """Largest eigenvalue of a step: rho for an infinitely stiff spring, a third-order error for a soft one."""

    def spring(step, stiffness):
        c = step_coefficients(step, rho)
        # balance: acceleration terms + stiffness * position terms = 0 for (x, v, a) -> a1
        by_new = c.acceleration + stiffness * c.position
        a1 = (
            -np.array([stiffness, stiffness * c.position_v, c.acceleration_a + stiffness * c.position_a])
            / by_new
        )
        x1 = np.array([1.0, c.step, c.end_position_a]) + c.end_position * a1
        v1 = np.array([0.0, 1.0, c.end_velocity_a]) + c.end_velocity * a1
        return np.linalg.eigvals(np.array([x1, v1, a1]))

    assert np.abs(spring(1.0, 1e12)).max() == pytest.approx(rho, abs=1e-4)
    errors = [np.abs(spring(h, 1.0) - np.exp(1j * h)).min() for h in (0.1, 0.05)]
    assert errors[0] / errors[1] == pytest.approx(8.0, rel=0.1)
