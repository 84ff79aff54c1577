"""Static equilibrium: its derivatives and what it says when there is none."""

import numpy as np
import pytest
from hasel_sim.errors import SimulationError
from hasel_sim.run import Run
from hasel_sim.simulate import simulate


def _start(model, names=()):
    run = Run("hanging", np.array([0.0, 0.01]), initial_state="static_equilibrium")
    return simulate(model, run, names)


def test_a_body_let_go_from_its_own_equilibrium_stays(rectangle):
    """Started in static equilibrium under the full load, a beam does not move."""
    model = rectangle(youngs_modulus=1e5, height=0.02, gravity=9.81, tolerance_m=1e-12)
    run = Run("still", np.arange(25) / 120, initial_state="static_equilibrium")
    sin_theta = simulate(model, run).sin_theta
    assert sin_theta[0] < -0.05
    assert np.ptp(sin_theta) < 1e-8


def test_the_load_factor_scales_the_start_of_a_stiff_beam(rectangle):
    """Half the load, half the deflection, as long as it is small; no load, straight."""
    model = rectangle(youngs_modulus=1e8, height=0.02, gravity=9.81)
    angles = [
        simulate(
            model, Run("", np.zeros(1), initial_state="static_equilibrium", initial_load_factor=f)
        ).sin_theta[0]
        for f in (0.0, 0.5, 1.0)
    ]
    assert angles[0] == pytest.approx(0.0, abs=1e-12)
    assert angles[1] == pytest.approx(0.5 * angles[2], rel=1e-3)


def test_a_given_shape_is_let_go_from_rest(rectangle):
    """A held shape is the first frame; released from its equilibrium's shape without load, a beam swings back."""
    loaded = rectangle(youngs_modulus=1e5, height=0.02, gravity=9.81)
    shape = simulate(
        loaded, Run("", np.zeros(1), initial_state="static_equilibrium"), keep_shapes=True
    ).shapes[0]
    model = rectangle(youngs_modulus=1e5, height=0.02)
    run = Run("held", np.arange(60) / 120, initial_state="held_shape", initial_shape=shape)
    simulation = simulate(model, run, keep_shapes=True)
    assert simulation.shapes[0] == pytest.approx(shape)
    first = simulation.sin_theta[0]
    assert first < -0.05
    assert simulation.sin_theta[1] == pytest.approx(first, rel=0.1)
    assert simulation.sin_theta.max() > -0.8 * first


def test_a_held_shape_of_another_mesh_is_refused(rectangle):
    """One sentence says how many nodes were expected."""
    run = Run("held", np.zeros(1), initial_state="held_shape", initial_shape=np.zeros((3, 2)))
    with pytest.raises(SimulationError, match=r"expected \(\d+, 2\)"):
        simulate(rectangle(), run)


def test_the_slope_of_the_start_agrees_with_differences(rectangle, tip_force):
    """Derivative of the starting angle by a load, to 1e-6."""
    model = rectangle(youngs_modulus=1e5, height=0.02, gravity=1.0, effects=[tip_force])
    found = _start(model, ["tip_force.force"]).slopes[0, 0]
    step = 1e-4
    above, below = (_start(model.with_values({"tip_force.force": f})).sin_theta[0] for f in (step, -step))
    assert found == pytest.approx((above - below) / (2 * step), rel=1e-6)


def test_a_load_beyond_all_strength_is_reported(rectangle):
    """No stack trace but a sentence with a next step."""
    model = rectangle(youngs_modulus=1e-2, gravity=1e4)
    with pytest.raises(SimulationError, match=r"static equilibrium.*check stiffness"):
        _start(model)
