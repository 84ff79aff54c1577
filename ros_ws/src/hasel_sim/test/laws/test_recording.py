# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What NumPy does with an array of numbers that are known later is recorded, or it is said why not."""

import math

import numpy as np
import pytest
from hasel_sim.laws.expressions import Graph
from hasel_sim.laws.program import Program
from hasel_sim.laws.recording import NotTraceableError, Traced

X = np.random.default_rng(5).uniform(0.2, 0.9, (6, 40))


def _assigned(x):
    out = np.zeros_like(x)
    out[:, 0], out[:, 1] = x[:, 1] ** 2, -x[:, 0]
    return out


def _in_place(x):
    out = x * 1.0
    out *= 3.0
    out[:, 1] += x[:, 0]
    return out


COMPUTED = {
    "arithmetic": lambda x: (2.0 - x) / (1.0 + x**3) - np.float64(0.3) * x,
    "broadcasting": lambda x: np.sqrt(x[:, 0] * x[:, 1])[:, None] * x,
    "sums": lambda x: x / np.sum(x * x, axis=1, keepdims=True) + x.sum(),
    "norm": lambda x: x / np.linalg.norm(x, axis=1)[:, None],
    "einsum": lambda x: np.einsum("ni,ni->n", x, x)[:, None] * x,
    "a matrix": lambda x: x @ np.array([[0.6, -0.8], [0.8, 0.6]]),
    "where": lambda x: np.where(x[:, :1] > x[:, 1:], x, -x) * (x < 0.5),
    "clip": lambda x: np.clip(x, 0.4, 0.6) + np.maximum(0.5, x) + np.minimum(x, 0.3),
    "stacks": lambda x: (
        np.stack([x[:, 1], np.tanh(x[:, 0])], axis=1) + np.concatenate([x[:, 1:], x[:, :1]], axis=1)
    ),
    "assignment": _assigned,
    "in place": _in_place,
    "rows": lambda x: np.array([[row[0] * row[1], row[1]] for row in x], dtype=object),
}


@pytest.mark.parametrize("how", COMPUTED)
def test_what_is_recorded_is_what_is_computed(how):
    """For three points of two components, at 40 states."""
    graph, compute = Graph(), COMPUTED[how]
    nodes = np.asarray(compute(Traced.inputs(graph, "x", (3, 2))), dtype=object).ravel()
    nodes = [n.item() if isinstance(n, np.ndarray) else n for n in nodes]
    program = Program(list(enumerate(nodes)), lambda name: False)
    found = program.run(lambda name: X[name[1]], X.shape[1], len(nodes))
    with np.errstate(all="raise"):
        expected = np.array([np.asarray(compute(x.reshape(3, 2)), dtype=float).ravel() for x in X.T]).T
    assert found == pytest.approx(expected, rel=1e-13)


@pytest.mark.parametrize(
    ("compute", "why"),
    [
        (lambda x: x if x[0, 0] > 0.0 else -x, "decides something by a number.*use np.where"),
        (lambda x: math.sqrt(x[0, 0]) * x, "wants these: begin arrays"),
        (lambda x: np.array(x, dtype=float), "into an array of plain numbers"),
        (lambda x: np.cumsum(x), "np.add.accumulate"),
        (lambda x: np.floor(x), "np.floor, which is not compiled"),
    ],
)
def test_what_cannot_be_recorded_says_why(compute, why):
    """Branches on numbers, functions for plain numbers, and those of NumPy that are not known."""
    with pytest.raises(NotTraceableError, match=why):
        compute(Traced.inputs(Graph(), "x", (3, 2)))
