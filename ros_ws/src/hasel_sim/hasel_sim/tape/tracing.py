"""Arrays of numbers that are known later, which NumPy takes for arrays: what is computed with them is recorded."""

from collections.abc import Callable, Hashable
from functools import partial

import numpy as np

from hasel_sim.tape.expressions import Graph, Node


class NotTraceableError(Exception):
    """A method does with its arguments what cannot be recorded; the text says what."""


class Traced(np.ndarray):
    """An array of nodes; arithmetic, elementwise functions, `where`, sums and whatever only moves entries work."""

    @staticmethod
    def of(nodes: object) -> "Traced":
        """From nodes in an array, or a single one."""
        return np.asarray(nodes, dtype=object).view(Traced)

    @staticmethod
    def inputs(graph: Graph, name: Hashable, shape: tuple[int, ...]) -> "Traced":
        """An array of inputs; each is named (name, its place in the flat array)."""
        nodes = np.empty(shape, dtype=object)
        for place, index in enumerate(np.ndindex(shape)):
            nodes[index] = graph.input((name, place))
        return Traced.of(nodes)

    def __array_ufunc__(self, ufunc, method, *inputs, out=None, **options):
        """Record an elementwise function, a matrix product or a sum."""
        options = {
            name: given for name, given in options.items() if given is not _DEFAULTS.get(name, _UNKNOWN)
        }
        known = {"axis", "keepdims"} if method == "reduce" else set()
        if method not in ("__call__", "reduce") or not set(options) <= known:
            raise NotTraceableError(f"it uses np.{ufunc.__name__}.{method} or options of it")
        plain = [np.asarray(x, dtype=object) for x in inputs]
        if method == "reduce" and options.get("axis", 0) is None:
            plain, options["axis"] = [plain[0].ravel()], 0
        if ufunc is np.matmul:
            result = np.matmul(*plain)
        else:
            each = np.frompyfunc(partial(_recorded, _graph_of(plain), ufunc.__name__), ufunc.nin, 1)
            result = (each if method == "__call__" else each.reduce)(*plain, **options)
        if out is None:
            return Traced.of(result)
        out[0][...] = result
        return out[0]

    def __array_function__(self, function, types, args, kwargs):
        """Functions that only move entries are NumPy's own."""
        if function in _FUNCTIONS:
            return _FUNCTIONS[function](*args, **kwargs)
        result = super().__array_function__(function, types, args, kwargs)
        return Traced.of(result) if isinstance(result, np.ndarray) else result

    def __getitem__(self, key):
        return Traced.of(np.asarray(self)[key])

    def __iter__(self):
        return (self[index] for index in range(len(self)))

    def __bool__(self) -> bool:
        raise NotTraceableError(
            "it decides something by a number that changes as the body moves: use np.where"
        )

    def __float__(self) -> float:
        raise NotTraceableError(
            "it puts what changes as the body moves into an array of plain numbers, or a function that wants these: "
            "begin arrays with np.zeros_like(at.…), and use NumPy's functions"
        )


def _where(condition, yes, no) -> Traced:
    plain = [np.asarray(x, dtype=object) for x in (condition, yes, no)]
    return Traced.of(np.frompyfunc(partial(_recorded, _graph_of(plain), "where"), 3, 1)(*plain))


def _norm(x, ord=None, axis=None, keepdims=False) -> Traced:
    if ord not in (None, 2):
        raise NotTraceableError(f"it uses np.linalg.norm with ord={ord}")
    return np.sqrt(np.sum(x * x, axis=axis, keepdims=keepdims))


_UNKNOWN = object()
_DEFAULTS = {"where": True, "initial": np._NoValue, "dtype": None}
"""Options that NumPy's own sums name though nobody asks for them."""
_FUNCTIONS: dict[Callable, Callable] = {np.where: _where, np.linalg.norm: _norm}


def _graph_of(arrays: list[np.ndarray]) -> Graph:
    return next(x.graph for array in arrays for x in array.flat if isinstance(x, Node))


def _recorded(graph: Graph, operation: str, *operands: Node | float) -> Node:
    try:
        return graph.apply(operation, *operands)
    except KeyError:
        raise NotTraceableError(f"it uses np.{operation}, which is not compiled") from None


def _operator(operation: str, turned: bool) -> Callable:
    def apply(self: Node, other):
        if not isinstance(other, Node | float | int | np.floating | np.integer):
            return NotImplemented
        return _recorded(self.graph, operation, *((other, self) if turned else (self, other)))

    return apply


for _name, _operation in (
    ("add", "add"),
    ("sub", "subtract"),
    ("mul", "multiply"),
    ("truediv", "divide"),
    ("pow", "power"),
):
    setattr(Node, f"__{_name}__", _operator(_operation, turned=False))
    setattr(Node, f"__r{_name}__", _operator(_operation, turned=True))
Node.__float__ = Traced.__float__  # type: ignore[attr-defined]
Node.__bool__ = Traced.__bool__  # type: ignore[attr-defined]
