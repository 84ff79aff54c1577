"""Static bending against beam theory."""

import numpy as np
import pytest
from scipy.integrate import solve_bvp

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
