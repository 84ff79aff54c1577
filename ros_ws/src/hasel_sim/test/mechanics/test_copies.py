"""Copies of a state for one call of an effect, and what its answers say of the derivatives."""

import numpy as np
import pytest
from hasel_sim.mechanics.copies import ALONE, Copies

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
