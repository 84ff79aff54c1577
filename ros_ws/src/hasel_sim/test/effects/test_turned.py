# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""A body that lies another way: the same angle, except where an effect's physics names a direction."""

import numpy as np
import pytest
from hasel_sim.effects.registry import catalogue
from hasel_sim.run import Run
from hasel_sim.simulate import simulate

DIRECTED = {"tether": "holds the body back sideways only"}


def turned_angle(model, run, degrees: float) -> np.ndarray:
    """sin theta of a run that starts at rest with the whole body turned."""
    cos, sin = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    rest = simulate(model, Run("rest", run.time[:2]), keep_shapes=True).shapes[0]
    shape = rest @ np.array([[cos, sin], [-sin, cos]])
    turned = Run(run.name, run.time, run.schedule, "held_shape", initial_shape=shape)
    return simulate(model, turned).sin_theta


@pytest.mark.parametrize("identity", [name for name in catalogue() if name not in DIRECTED])
def test_the_angle_does_not_depend_on_the_heading(identity, coarse_swimmer, short_boxes):
    """Turned by 37 and by 90 degrees, every effect gives the same angle to 1e-6."""
    effect = catalogue()[identity]
    values = {f"{identity}.{name}": value for name, value in effect.typical().items()}
    model = coarse_swimmer.with_numerics(mesh_density=1.0).with_effects(identity).with_values(values)
    straight = turned_angle(model, short_boxes, 0.0)
    assert np.ptp(straight) > 0.05
    for degrees in (37.0, 90.0):
        assert turned_angle(model, short_boxes, degrees) == pytest.approx(straight, abs=1e-6)


@pytest.mark.parametrize("identity", DIRECTED)
def test_what_names_a_direction_depends_on_the_heading(identity, coarse_swimmer, short_boxes):
    """Otherwise it would not be an exception."""
    values = {f"{identity}.stiffness": 10.0, f"{identity}.position": 0.15}
    model = coarse_swimmer.with_effects(identity).with_values(values)
    straight, across = (turned_angle(model, short_boxes, degrees) for degrees in (0.0, 90.0))
    assert np.abs(straight - across).max() > 1e-4
