# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Skin friction."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.effects.base import SiteState, Surroundings
from hasel_sim.effects.registry import find_effects

DENSITY, NU, LENGTH, DEPTH = 998.0, 1e-6, 0.2, 0.05


def _drag(velocity: tuple[float, float], nu: float = NU, **values) -> float:
    """Force along the line per length and depth [N/m^2]."""
    nothing, along = np.zeros((1, 2)), np.array([[1.0, 0.0]])
    at = SiteState(
        position=nothing, velocity=np.array([velocity]), acceleration=nothing, tangent=along,
        tangent_rate=nothing, reference=nothing, rest_normal=nothing, measure=np.ones(1), voltage=np.zeros(0),
        contraction=np.zeros(0), time=0.0, gravity=np.zeros(2),
        surroundings=Surroundings(DENSITY, nu * DENSITY, DEPTH, LENGTH),
    )  # fmt: skip
    effect = find_effects(("skin_friction",))[0]
    force = effect.force(at, SimpleNamespace(**{**effect.null(), **values}))
    assert force[0, 1] == 0.0
    turned = replace(at, velocity=at.velocity[:, ::-1] * [-1, 1], tangent=np.array([[0.0, 1.0]]))
    assert effect.force(turned, SimpleNamespace(**{**effect.null(), **values}))[0, 1] == pytest.approx(
        force[0, 0]
    )
    return float(force[0, 0])


def test_both_sides_of_a_plate_at_high_and_low_reynolds_numbers():
    """Blasius' 1.328 / sqrt(Re) at high numbers; at Re = 10 the measured drag of a plate is near 0.78 per side."""
    nu = 1e-9
    fast = -_drag((1.0, 0.0), nu=nu, along=1.0)
    assert fast == pytest.approx(DENSITY * 1.328 * np.sqrt(nu / LENGTH), rel=2e-3)
    slow = _drag((-0.1, 0.0), nu=0.1 * LENGTH / 10.0, along=1.0)
    assert slow / (DENSITY * 0.01) == pytest.approx(0.78, rel=0.02)


def test_flow_across_thins_the_layer_as_taylor_says():
    """1/2 rho H 5.4 sqrt(nu / (w H)) w u per length where the body moves mostly across itself."""
    u, w = 0.001, 0.5
    expected = 0.5 * DENSITY * 5.4 * np.sqrt(NU / (w * DEPTH)) * w * u
    assert -_drag((u, w), thinning=2.7) == pytest.approx(expected)
    assert -_drag((u, w), thinning=2.7, along=1.0) == pytest.approx(expected, rel=1e-2)
