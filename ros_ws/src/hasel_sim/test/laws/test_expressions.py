# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Expressions: every operation of the compiled loop is NumPy's, and its derivative that of its values."""

import numpy as np
import pytest
from hasel_sim.laws.expressions import OPERATIONS, Graph
from hasel_sim.laws.program import Program

POINTS = 300
RANGES = {"arcsin": (-0.9, 0.9), "arccos": (-0.9, 0.9), "power": (0.1, 2.0)}
RANGES |= dict.fromkeys(("log", "log1p", "log2", "log10", "sqrt"), (0.1, 2.0))
NUMBER = dict.fromkeys(
    ("add", "subtract", "multiply", "divide", "divide_or_zero", "power", "arctan2", "maximum", "minimum"), 2
) | {"greater": 2, "greater_equal": 2, "equal": 2, "where": 3}
OTHERS = (
    "square",
    "reciprocal",
    "hypot",
    "tan",
    "cbrt",
    "log2",
    "log10",
    "fabs",
    "less",
    "not_equal",
    "logical_or",
)


def _numbers(operation: str, seed: int = 0) -> np.ndarray:
    low, high = RANGES.get(operation, (-2.0, 2.0))
    count = 2 if operation in ("hypot", "less", "not_equal", "logical_or") else NUMBER.get(operation, 1)
    return np.random.default_rng(seed).uniform(low, high, (count, POINTS))


def _run(outputs, x: np.ndarray) -> np.ndarray:
    program = Program(list(enumerate(outputs)), lambda name: False)
    return program.run(lambda name: x[name], POINTS, len(outputs))


@pytest.mark.parametrize("operation", [*OPERATIONS, *OTHERS])
def test_an_operation_is_that_of_numpy(operation):
    """To round-off, at random numbers."""
    x, graph = _numbers(operation), Graph()
    (found,) = _run([graph.apply(operation, *map(graph.input, range(len(x))))], x)
    if operation == "divide_or_zero":
        operation = "divide"
    assert found == pytest.approx(np.asarray(getattr(np, operation)(*x), dtype=float), rel=1e-13)


@pytest.mark.parametrize("operation", [*OPERATIONS, *OTHERS])
def test_a_derivative_is_that_of_the_values(operation):
    """By every operand, as central differences find it; conditions are flat."""
    x, graph = _numbers(operation, seed=1), Graph()
    inputs = [graph.input(n) for n in range(len(x))]
    y = graph.apply(operation, *inputs)
    for n, one in enumerate(inputs):
        (found,) = _run(graph.derivatives([y], one), x)
        step = np.zeros_like(x)
        step[n] = 1e-6
        expected = (_run([y], x + step)[0] - _run([y], x - step)[0]) / 2e-6
        assert found == pytest.approx(expected, rel=1e-6, abs=1e-7)


def test_roots_have_the_derivative_that_products_with_them_have_at_zero():
    """sqrt(abs(x)) x at 0 has the derivative 0, as a drag at rest."""
    graph = Graph()
    x = graph.input(0)
    y = graph.apply("multiply", graph.apply("sqrt", graph.apply("absolute", x)), x)
    (found,) = _run(graph.derivatives([y], x), np.zeros((1, POINTS)))
    assert not found.any()


def test_equal_expressions_are_one_and_what_is_known_is_done_at_once():
    """x + y is y + x; times 0 is 0, plus 0 nothing, of constants a constant."""
    graph = Graph()
    x, y = graph.input("x"), graph.input("y")
    assert graph.apply("add", x, y) is graph.apply("add", y, x)
    assert graph.apply("multiply", x, 0.0).is_constant(0.0)
    assert graph.apply("add", graph.apply("multiply", x, 1.0), 0.0) is x
    assert graph.apply("sqrt", 4.0).is_constant(2.0)


def test_what_is_the_same_at_all_points_is_done_once():
    """Of 2 p^2 x only one product is left for the points."""
    graph = Graph()
    x, p = graph.input("x"), graph.input("p")
    twice = graph.apply("multiply", 2.0, graph.apply("power", p, 2.0))
    program = Program([(0, graph.apply("multiply", twice, x))], lambda name: name == "p")
    assert (len(program.before), len(program.operations)) == (2, 1)
