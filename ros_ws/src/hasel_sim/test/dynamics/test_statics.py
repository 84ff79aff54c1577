# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Static equilibrium: its derivatives and what it says when there is none.

Static bending against beam theory.
"""

from dataclasses import replace

import numpy as np
import pytest
from hasel_sim.effects.base import EffectParameter, MaterialEffect
from hasel_sim.effects.registry import find_effects
from hasel_sim.errors import SimulationError
from hasel_sim.mesh.mesh import Region
from hasel_sim.model import Parameter
from hasel_sim.run import Run
from hasel_sim.simulate import simulate
from scipy.integrate import solve_bvp


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


def test_at_rest_means_in_the_equilibrium_of_all_that_acts(rectangle):
    """A clamped beam under its weight, bent when relaxed, with a load at its tip, starts where it stays."""
    model = rectangle(
        youngs_modulus=1e5,
        height=0.02,
        gravity=5.0,
        effects=find_effects(("payload", "pre_bend")),
        values={"payload.mass": 0.3, "pre_bend.curvature": 1.0},
        tolerance_m=1e-12,
    )
    found = simulate(model, Run("rest", np.arange(13) / 120)).sin_theta
    assert abs(found[0]) > 0.05
    assert np.ptp(found) < 1e-8


class Pretension(MaterialEffect):
    """Muscles that pull when relaxed."""

    id = "pretension"
    physics = "The upper film was glued on under tension."
    equation = "tension += p"
    parameters = (EffectParameter("stress", "p", "Pa", 0.0, 0.0, 1e4, 300.0),)
    regions = (Region.UPPER_MUSCLE,)

    def first_piola(self, at, p):
        """Along the fibres."""
        return at.along_fibre(np.full(len(at.deformation), p.stress))


def test_an_unequal_pretension_of_the_muscles_bends_the_body_at_rest(swimmer):
    """The body starts bent and stays so."""
    stress = Parameter("pretension.stress", 300.0, "Pa", 0.0, 1e4)
    model = swimmer.with_numerics(mesh_density=0.5, tolerance_m=1e-11)
    model = replace(
        model, effects=(Pretension(),), parameters={**model.parameters, "pretension.stress": stress}
    )
    found = simulate(model, Run("rest", np.arange(13) / 120)).sin_theta
    assert found[0] > 0.02
    assert np.ptp(found) < 1e-8


FREE = {
    "payload.mass": 0.02,
    "pre_bend.curvature": 1.0,
    "gravity_tilt.tilt": 0.05,
    "tether.stiffness": 5.0,
    "tether.position": 0.06,
}


def _free(swimmer, *without):
    values = {name: value for name, value in FREE.items() if name.partition(".")[0] not in without}
    effects = {name.partition(".")[0]: None for name in values}
    return (
        swimmer.with_numerics(mesh_density=0.5, tolerance_m=1e-12).with_effects(*effects).with_values(values)
    )


def test_a_free_body_that_nothing_holds_sets_off_without_bending_anew(swimmer):
    """On a tilted plane it slides from the shape that it has anyhow."""
    level, tilted = (_free(swimmer, "tether", "payload", *more) for more in (("gravity_tilt",), ()))
    found = simulate(tilted, Run("rest", np.arange(13) / 120), keep_shapes=True)
    expected = simulate(level, Run("rest", np.arange(13) / 120)).sin_theta
    assert expected[0] > 0.02
    assert found.sin_theta == pytest.approx(expected, abs=1e-6)
    assert np.mean(found.shapes[-1][:, 1] - found.shapes[0][:, 1]) == pytest.approx(
        0.5 * 9.81 * np.sin(0.05) * 0.1**2, rel=1e-3
    )


def test_a_tether_holds_a_free_body_where_its_spring_is_slack(swimmer):
    """The bent body rests with the tethered point on the line, instead of being pulled there."""
    found = simulate(_free(swimmer, "gravity_tilt"), Run("rest", np.arange(61) / 120)).sin_theta
    assert found[0] > 0.02
    assert np.ptp(found) < 1e-8


@pytest.mark.parametrize("without", [(), ("tether",), ("gravity_tilt",)])
def test_the_slopes_of_a_free_body_at_rest_agree_with_differences(without, swimmer):
    """By every parameter, to 3e-6, in the first frames: the start and what it starts."""
    model, run = _free(swimmer, *without), Run("rest", np.arange(4) / 120)
    names = [name for name in FREE if name in model.parameters]
    slopes = simulate(model, run, names).slopes
    for column, name in enumerate(names):
        value = model.parameters[name].value
        step = 1e-3 * max(abs(value), 0.1)
        far, near = (
            simulate(model.with_values({name: value + n * step}), run).sin_theta
            - simulate(model.with_values({name: value - n * step}), run).sin_theta
            for n in (2, 1)
        )
        expected = (8 * near - far) / (12 * step)
        assert slopes[:, column] == pytest.approx(expected, abs=3e-6 * np.abs(expected).max() + 1e-8), name


@pytest.mark.parametrize("poissons_ratio", [0.3, 0.499])
def test_a_trial_shape_that_cannot_be_solved_halves_the_load(
    poissons_ratio, rectangle, tip_force, equilibrium_of
):
    """A slender cantilever under three times E I / L^2, fully integrated: the tip is where the elastica puts it."""
    length, height, stiffness = 0.1, 0.0005, 1e7
    bending = stiffness / (1 - poissons_ratio**2) * height**3 / 12
    model = rectangle(
        length,
        height,
        youngs_modulus=stiffness,
        poissons_ratio=poissons_ratio,
        effects=(tip_force,),
        values={"tip_force.force": 3 * bending / length**2},
        quadrature_order=3,
    )
    shift, mesh = equilibrium_of(model)
    tip = shift[np.argmax(mesh.nodes[:, 0])]
    # Mattiasson, Int. J. Numer. Meth. Eng. 17 (1981) 145: w/L = 0.60325, u/L = 0.25442
    assert tip[1] / length == pytest.approx(0.60325, abs=0.03)
    assert -tip[0] / length == pytest.approx(0.25442, abs=0.03)


LENGTH, HEIGHT, MODULUS, RATIO = 0.1, 0.01, 1e5, 0.3


def _flexural_modulus(plane: str) -> float:
    return MODULUS / (1 - RATIO**2) if plane == "strain" else MODULUS


def _tip(displacement, mesh) -> np.ndarray:
    x, y = mesh.nodes.T
    return displacement[(x > x.max() - 1e-9) & (np.abs(y) < 1e-9)][0]


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("quadrature_order", [2, 3])
def test_cantilever_under_a_small_tip_force_bends_as_timoshenko_says(
    plane, quadrature_order, rectangle, tip_force, equilibrium_of
):
    """Tip deflection P L^3 / 3 E I + P L / kappa G A within 1 %."""
    force = 1e-4
    model = rectangle(
        LENGTH,
        HEIGHT,
        youngs_modulus=MODULUS,
        plane=plane,
        effects=[tip_force],
        values={"tip_force.force": force},
        quadrature_order=quadrature_order,
    )
    bending = force * LENGTH**3 / (3 * _flexural_modulus(plane) * HEIGHT**3 / 12)
    kappa = 10 * (1 + RATIO) / (12 + 11 * RATIO)
    shear = force * LENGTH / (kappa * MODULUS / (2 * (1 + RATIO)) * HEIGHT)
    assert _tip(*equilibrium_of(model))[1] == pytest.approx(bending + shear, rel=0.01)


def test_cantilever_under_its_weight_sags_as_timoshenko_says(rectangle, equilibrium_of):
    """Tip deflection q L^4 / 8 E I + q L^2 / 2 kappa G A within 1 %."""
    gravity = 1e-3
    model = rectangle(LENGTH, HEIGHT, youngs_modulus=MODULUS, gravity=gravity)
    load = 1000.0 * HEIGHT * gravity
    bending = load * LENGTH**4 / (8 * _flexural_modulus("strain") * HEIGHT**3 / 12)
    kappa = 10 * (1 + RATIO) / (12 + 11 * RATIO)
    shear = load * LENGTH**2 / (2 * kappa * MODULUS / (2 * (1 + RATIO)) * HEIGHT)
    assert -_tip(*equilibrium_of(model))[1] == pytest.approx(bending + shear, rel=0.01)


def _elastica_tip(load: float) -> tuple[float, float]:
    """Tip (x, y) / L of a clamped elastica under a transverse end load P L^2 / E I = load."""

    def slopes(s, state):
        angle, curvature, _, _ = state
        return np.array([curvature, -load * np.cos(angle), np.cos(angle), np.sin(angle)])

    def ends(start, end):
        return np.array([start[0], end[1], start[2], start[3]])

    s = np.linspace(0, 1, 101)
    guess = np.array([s, 1 - s, s, 0.5 * s**2])
    return tuple(solve_bvp(slopes, ends, s, guess, tol=1e-9).y[2:, -1])


@pytest.mark.parametrize("load", [1.0, 3.0, 8.0])
def test_cantilever_under_a_large_tip_force_follows_the_elastica(load, rectangle, tip_force, equilibrium_of):
    """Tip position within 1 % of the length, up to a rotation of 70 degrees."""
    height = LENGTH / 60
    rigidity = _flexural_modulus("strain") * height**3 / 12
    model = rectangle(
        LENGTH,
        height,
        youngs_modulus=MODULUS,
        effects=[tip_force],
        values={"tip_force.force": load * rigidity / LENGTH**2},
    )
    displacement, mesh = equilibrium_of(model)
    tip = (_tip(displacement, mesh) + (LENGTH, 0.0)) / LENGTH
    expected = _elastica_tip(load)
    assert tip == pytest.approx(expected, rel=0.01)
