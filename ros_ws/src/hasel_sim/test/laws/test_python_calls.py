# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What effects are given: made when they ask for it, and lane by lane where they look at the drive.

Copies of a state for one call of an effect, and what its answers say of the derivatives.
"""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest
from hasel_sim.laws.python_calls import ALONE, Copies, by_group, grouped, on_demand


@dataclass(frozen=True)
class Points:
    """A position, and the drive."""

    position: np.ndarray
    time: float


LAZY = on_demand(Points, ("time",))


def test_what_is_not_asked_for_is_not_made():
    """What was made is kept; a look at the drive is noted."""
    made = []
    points = LAZY({}, lambda name: made.append(name) or len(made))
    assert isinstance(points, Points)
    assert (points.position, points.position) == (1, 1)
    assert made == ["position"]
    assert not points.looked
    assert points.time == 2
    assert points.looked


def test_an_unknown_attribute_is_named_with_the_nearest():
    """As a typing error in an effect of one's own."""
    with pytest.raises(AttributeError, match=r"Points has no 'positon'.*position"):
        _ = LAZY({}, lambda name: 0.0).positon


def test_lanes_with_the_same_values_are_asked_at_once_unless_they_must_not():
    """Lane 2 lacks the effect and gets zero; an answer of None asks the lanes of a group one by one."""
    first, other = SimpleNamespace(size=1.0), SimpleNamespace(size=2.0)
    groups, asked = grouped([first, other, None, first]), []

    def ask(lanes, values):
        asked.append(lanes.tolist())
        if len(lanes) > 1:
            return None
        return np.full((2 * 5, 2), values.size * (1 + lanes[0]))

    found = by_group(groups, (2, 4, 5, 2), ask)
    assert asked == [[0, 3], [0], [3], [1]]
    assert found[:, :, 0, 0].tolist() == [[1.0, 4.0, 0.0, 4.0]] * 2


LANES, N = 3, 5
STEPS = {"position": 1e-6, "velocity": 1e-5}


@pytest.fixture
def fields():
    """Two quantities at five points in three lanes, [n, 2, lanes]."""
    draw = np.random.default_rng(4).standard_normal
    return {name: draw((N, 2, LANES)) for name in STEPS}


def answer(x: np.ndarray, v: np.ndarray) -> np.ndarray:
    """A force of position and velocity at points [..., 2]."""
    return np.stack([x[..., 0] * v[..., 1], np.sin(x[..., 1]) + v[..., 0] ** 2], axis=-1)


@pytest.mark.parametrize("kind", [Copies.one_sided, Copies.central])
def test_derivatives_are_those_of_the_answer(kind, fields):
    """By position and by velocity, times a factor of each lane, added to what is there."""
    copies = kind(STEPS, 2)
    found = answer(*(copies.rows(name, field) for name, field in fields.items()))
    x, v = fields.values()
    nothing = np.zeros_like(x[:, 0])
    exact = {
        "position": np.array([[v[:, 1], nothing], [nothing, np.cos(x[:, 1])]]),
        "velocity": np.array([[nothing, x[:, 0]], [2 * v[:, 0], nothing]]),
    }
    factor = np.array([1.0, -2.0, 0.5])
    for name in STEPS:
        out = np.ones((N, 2, 2, LANES))
        copies.add_derivative(name, found, factor, out)
        assert out - 1.0 == pytest.approx(factor * exact[name].transpose(2, 0, 1, 3), abs=1e-4)


def test_alone_is_the_state_as_it_is(fields):
    """One copy, lane by lane."""
    assert len(ALONE) == 1
    rows = ALONE.rows("position", fields["position"])
    assert rows[0].transpose(1, 2, 0) == pytest.approx(fields["position"], abs=0.0)
