# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Expressions of numbers that are known later, and their derivatives.

A graph grows as arithmetic is done with its nodes. Equal expressions are one node, and what is known at once
(constants, sums with 0, products with 1) is done at once.
"""

from collections.abc import Callable, Hashable, Sequence
from typing import Any

import numpy as np

OPERATIONS = (
    "add",
    "subtract",
    "multiply",
    "divide",
    "divide_or_zero",
    "negative",
    "absolute",
    "sign",
    "sqrt",
    "power",
    "exp",
    "expm1",
    "log",
    "log1p",
    "sin",
    "cos",
    "arcsin",
    "arccos",
    "arctan",
    "arctan2",
    "sinh",
    "cosh",
    "tanh",
    "maximum",
    "minimum",
    "greater",
    "greater_equal",
    "equal",
    "where",
)
"""What the compiled loop can do, with the names of NumPy; a condition is 1 or 0. `divide_or_zero`: 0 where the divisor
is 0, for derivatives of roots and powers, which vanish in every product there that has a derivative.
"""


class Node:
    """One number: a constant, an input with a name, or an operation on others; `recording` gives it arithmetic."""

    __slots__ = ("graph", "operands", "operation", "place", "value")

    def __init__(self, graph: "Graph", operation: str, operands: tuple["Node", ...], value: Any) -> None:
        self.graph, self.operation, self.operands, self.value = graph, operation, operands, value
        self.place = len(graph.nodes)
        graph.nodes.append(self)

    def is_constant(self, value: float | None = None) -> bool:
        """Whether it is a constant, or this one."""
        return self.operation == "constant" and value in (None, self.value)


class Graph:
    """All nodes of one law, every node behind its operands."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self._known: dict[Hashable, Node] = {}

    def _node(self, operation: str, operands: tuple[Node, ...] = (), value: Hashable = None) -> Node:
        key = operation, value, *(operand.place for operand in operands)
        if key not in self._known:
            self._known[key] = Node(self, operation, operands, value)
        return self._known[key]

    def constant(self, value: float) -> Node:
        """A number that never changes."""
        return self._node("constant", value=float(value))

    def input(self, name: Hashable) -> Node:
        """A number that is given later, by its name."""
        return self._node("input", value=name)

    def apply(self, operation: str, *operands: Node | float) -> Node:
        """The result of one of NumPy's elementwise functions. Raises KeyError for one that is not known."""
        nodes = tuple(x if isinstance(x, Node) else self.constant(x) for x in operands)
        if operation in _MADE_OF_OTHERS:
            return _MADE_OF_OTHERS[operation](self.apply, *nodes)
        if operation not in OPERATIONS:
            raise KeyError(operation)
        if all(node.is_constant() for node in nodes) and operation != "divide_or_zero":
            return self.constant(getattr(np, operation)(*(node.value for node in nodes)))
        simpler = self._simpler(operation, nodes)
        return self._node(operation, nodes) if simpler is None else simpler

    def _simpler(self, operation: str, nodes: tuple[Node, ...]) -> Node | None:
        """The same by less, if there is such."""
        a, b = nodes[0], nodes[-1]
        if operation in ("add", "multiply") and a.place > b.place:
            return self.apply(operation, b, a)
        if operation == "add":
            return b if a.is_constant(0.0) else a if b.is_constant(0.0) else None
        if operation == "subtract":
            return a if b.is_constant(0.0) else self.apply("negative", b) if a.is_constant(0.0) else None
        if operation == "negative":
            return a.operands[0] if a.operation == "negative" else None
        if operation in ("divide", "divide_or_zero"):
            if a.is_constant(0.0):
                return a
            if b.is_constant() and b.value:
                return self.apply("multiply", a, 1.0 / b.value)
            return None if a.is_constant(1.0) else self.apply("multiply", a, self.apply(operation, 1.0, b))
        if operation == "multiply":
            for constant, other in ((a, b), (b, a)):
                if constant.is_constant(0.0) or other.is_constant(1.0):
                    return constant
                if constant.is_constant(-1.0):
                    return self.apply("negative", other)
        if operation == "power" and b.is_constant():
            return self._of_constant_power(a, float(b.value))
        if operation == "where" and nodes[1] is nodes[2]:
            return nodes[1]
        return None

    def _of_constant_power(self, base: Node, exponent: float) -> Node | None:
        if exponent == 0.5:
            return self.apply("sqrt", base)
        if exponent == 0.0:
            return self.constant(1.0)
        if exponent in (1.0, 2.0, 3.0, 4.0):
            half = self._of_constant_power(base, exponent // 2) if exponent > 1.0 else base
            twice = half if exponent == 1.0 else self.apply("multiply", half, half)
            return self.apply("multiply", twice, base) if exponent == 3.0 else twice
        return self.apply("divide", 1.0, base) if exponent == -1.0 else None

    def derivatives(self, outputs: Sequence[Node], by: Node) -> list[Node]:
        """Derivatives of the outputs by one input."""
        zero, last = self.constant(0.0), max((node.place for node in outputs), default=-1)
        found: dict[int, Node] = {by.place: self.constant(1.0)}
        for node in self.nodes[: last + 1]:
            moved = [found.get(operand.place, zero) for operand in node.operands]
            if all(change is zero for change in moved):
                continue
            found[node.place] = _derivative(self.apply, node, moved)
        return [found.get(node.place, zero) for node in outputs]


Apply = Callable[..., Node]
_Partials = tuple[Callable[[], Node | float], ...]
"""What makes the derivative by each operand."""


def _derivative(f: Apply, node: Node, moved: Sequence[Node]) -> Node:
    """What an operation changes by, for what its operands change by."""
    x = node.operands
    if node.operation == "where":
        return f("where", x[0], moved[1], moved[2])
    if node.operation in ("maximum", "minimum"):
        first = f("greater_equal", *(x if node.operation == "maximum" else x[::-1]))
        return f("where", first, *moved)
    total: Node = node.graph.constant(0.0)
    for partial, change in zip(_PARTIAL[node.operation](f, node, *x), moved, strict=True):
        if not change.is_constant(0.0):
            total = f("add", total, f("multiply", partial(), change))
    return total


def _power_partials(f: Apply, node: Node, base: Node, exponent: Node) -> _Partials:
    above = f("greater", base, 0.0)
    return (
        lambda: f("multiply", exponent, f("divide_or_zero", node, base)),
        lambda: f("multiply", node, f("log", f("where", above, base, 1.0))),
    )


def _quotient_partials(f: Apply, operation: str, quotient: Node, divisor: Node) -> _Partials:
    inverse = f(operation, 1.0, divisor)
    return lambda: inverse, lambda: f("negative", f("multiply", quotient, inverse))


def _flat(f: Apply, node: Node, *x: Node) -> _Partials:
    return tuple(lambda: 0.0 for _ in x)


_PARTIAL: dict[str, Callable[..., _Partials]] = {
    "add": lambda f, y, a, b: (lambda: 1.0, lambda: 1.0),
    "subtract": lambda f, y, a, b: (lambda: 1.0, lambda: -1.0),
    "multiply": lambda f, y, a, b: (lambda: b, lambda: a),
    "divide": lambda f, y, a, b: _quotient_partials(f, "divide", y, b),
    "divide_or_zero": lambda f, y, a, b: _quotient_partials(f, "divide_or_zero", y, b),
    "negative": lambda f, y, a: (lambda: -1.0,),
    "absolute": lambda f, y, a: (lambda: f("sign", a),),
    "sign": _flat,
    "sqrt": lambda f, y, a: (lambda: f("divide_or_zero", 0.5, y),),
    "power": _power_partials,
    "exp": lambda f, y, a: (lambda: y,),
    "expm1": lambda f, y, a: (lambda: f("add", y, 1.0),),
    "log": lambda f, y, a: (lambda: f("divide", 1.0, a),),
    "log1p": lambda f, y, a: (lambda: f("divide", 1.0, f("add", a, 1.0)),),
    "sin": lambda f, y, a: (lambda: f("cos", a),),
    "cos": lambda f, y, a: (lambda: f("negative", f("sin", a)),),
    "arcsin": lambda f, y, a: (lambda: f("divide_or_zero", 1.0, f("cos", y)),),
    "arccos": lambda f, y, a: (lambda: f("divide_or_zero", -1.0, f("sin", y)),),
    "arctan": lambda f, y, a: (lambda: f("divide", 1.0, f("add", f("square", a), 1.0)),),
    "arctan2": lambda f, y, a, b: (
        lambda: f("divide_or_zero", b, f("add", f("square", a), f("square", b))),
        lambda: f("divide_or_zero", f("negative", a), f("add", f("square", a), f("square", b))),
    ),
    "sinh": lambda f, y, a: (lambda: f("cosh", a),),
    "cosh": lambda f, y, a: (lambda: f("sinh", a),),
    "tanh": lambda f, y, a: (lambda: f("subtract", 1.0, f("square", y)),),
    "greater": _flat,
    "greater_equal": _flat,
    "equal": _flat,
}
"""For each operation, from it, its result and its operands: what makes its derivative by each operand."""

_MADE_OF_OTHERS: dict[str, Callable[..., Node]] = {
    "square": lambda f, a: f("multiply", a, a),
    "reciprocal": lambda f, a: f("divide", 1.0, a),
    "positive": lambda f, a: a,
    "conjugate": lambda f, a: a,
    "fabs": lambda f, a: f("absolute", a),
    "float_power": lambda f, a, b: f("power", a, b),
    "hypot": lambda f, a, b: f("sqrt", f("add", f("square", a), f("square", b))),
    "tan": lambda f, a: f("divide", f("sin", a), f("cos", a)),
    "cbrt": lambda f, a: f("multiply", f("sign", a), f("power", f("absolute", a), 1.0 / 3.0)),
    "log2": lambda f, a: f("multiply", f("log", a), 1.0 / np.log(2.0)),
    "log10": lambda f, a: f("multiply", f("log", a), 1.0 / np.log(10.0)),
    "fmax": lambda f, a, b: f("maximum", a, b),
    "fmin": lambda f, a, b: f("minimum", a, b),
    "clip": lambda f, a, low, high: f("minimum", f("maximum", a, low), high),
    "less": lambda f, a, b: f("greater", b, a),
    "less_equal": lambda f, a, b: f("greater_equal", b, a),
    "not_equal": lambda f, a, b: f("subtract", 1.0, f("equal", a, b)),
    "logical_not": lambda f, a: f("equal", a, 0.0),
    "logical_and": lambda f, a, b: f("multiply", f("not_equal", a, 0.0), f("not_equal", b, 0.0)),
    "logical_or": lambda f, a, b: f("maximum", f("not_equal", a, 0.0), f("not_equal", b, 0.0)),
}
for _bitwise, _logical in (
    ("bitwise_and", "logical_and"),
    ("bitwise_or", "logical_or"),
    ("invert", "logical_not"),
):
    _MADE_OF_OTHERS[_bitwise] = _MADE_OF_OTHERS[_logical]
