# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""The law of an effect, recorded at one point: its value, and what it changes with the motion or with a parameter.

NumPy takes `Traced` arrays of numbers that are known later for arrays: what is computed with them is recorded.
"""

from collections.abc import Callable, Hashable, Iterable, Iterator, Mapping, Sequence
from functools import lru_cache, partial
from types import SimpleNamespace
from typing import Any

import numpy as np

from hasel_sim.effects.base import (
    Effect,
    ForceEffect,
    MaterialEffect,
    MaterialPoints,
    SiteState,
    Surroundings,
)
from hasel_sim.laws.expressions import Graph, Node
from hasel_sim.laws.program import Program


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

    def __array_ufunc__(
        self, ufunc: np.ufunc, method: str, *inputs: Any, out: Any = None, **options: Any
    ) -> "Traced":
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
            each = np.frompyfunc(partial(_applied, _graph_of(plain), ufunc.__name__), ufunc.nin, 1)
            result = (each if method == "__call__" else each.reduce)(*plain, **options)
        if out is None:
            return Traced.of(result)
        out[0][...] = result
        return out[0]

    def __array_function__(
        self,
        function: Callable[..., Any],
        types: Iterable[type],
        args: Iterable[Any],
        kwargs: Mapping[str, Any],
    ) -> Any:
        """Functions that only move entries are NumPy's own."""
        if function in _FUNCTIONS:
            return _FUNCTIONS[function](*args, **kwargs)
        result = super().__array_function__(function, types, args, kwargs)
        return Traced.of(result) if isinstance(result, np.ndarray) else result

    def __getitem__(self, key: Any) -> "Traced":
        return Traced.of(np.asarray(self)[key])

    def __iter__(self) -> Iterator["Traced"]:
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


def _where(condition: Any, yes: Any, no: Any) -> Traced:
    plain = [np.asarray(x, dtype=object) for x in (condition, yes, no)]
    return Traced.of(np.frompyfunc(partial(_applied, _graph_of(plain), "where"), 3, 1)(*plain))


def _norm(x: Traced, ord: Any = None, axis: int | None = None, keepdims: bool = False) -> Traced:
    if ord not in (None, 2):
        raise NotTraceableError(f"it uses np.linalg.norm with ord={ord}")
    return np.sqrt(np.sum(x * x, axis=axis, keepdims=keepdims))


_UNKNOWN = object()
_DEFAULTS = {"where": True, "initial": np._NoValue, "dtype": None}
"""Options that NumPy's own sums name though nobody asks for them."""
_FUNCTIONS: dict[Callable[..., Any], Callable[..., Traced]] = {np.where: _where, np.linalg.norm: _norm}


def _graph_of(arrays: list[np.ndarray]) -> Graph:
    return next(x.graph for array in arrays for x in array.flat if isinstance(x, Node))


def _applied(graph: Graph, operation: str, *operands: Node | float) -> Node:
    try:
        return graph.apply(operation, *operands)
    except KeyError:
        raise NotTraceableError(f"it uses np.{operation}, which is not compiled") from None


def _operator(operation: str, turned: bool) -> Callable[[Node, Any], Any]:
    def apply(self: Node, other: Any) -> Any:
        if not isinstance(other, Node | float | int | np.floating | np.integer):
            return NotImplemented
        return _applied(self.graph, operation, *((other, self) if turned else (self, other)))

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


OF_THE_SITES = ("position", "velocity", "acceleration", "tangent", "tangent_rate")
_STATES = 7
_USUAL: dict[str, tuple[Any, float]] = {
    "position": (0.1, 0.03),
    "velocity": (0.0, 0.2),
    "acceleration": (0.0, 2.0),
    "tangent": ((1.0, 0.0), 0.1),
    "tangent_rate": (0.0, 3.0),
    "reference": (0.1, 0.03),
    "rest_normal": ((0.0, 1.0), 0.1),
    "measure": (0.01, 0.001),
    "deformation": (((1.0, 0.0), (0.0, 1.0)), 0.05),
    "rate": (0.0, 1.0),
    "fibre": (65e3, 1e3),
    "shear": (22e3, 1e3),
    "contraction": (0.05, 0.01),
    "voltage": (0.0, 4e3),
    "time": (0.3, 0.1),
}
"""Middle and spread of the states at which a law is compared with the method that was recorded."""


class Law:
    """k numbers at a point as expressions of named inputs, (name, place); a parameter's name is ("p", its name).

    moving: quantities by which it is differentiated, with how many components each has; uniform: names of what is the
    same at all points, besides the parameters.
    """

    def __init__(
        self,
        graph: Graph,
        outputs: Sequence[Node],
        moving: dict[str, int],
        uniform: frozenset[str] = frozenset(),
    ) -> None:
        self._graph, self._outputs, self._uniform = graph, outputs, uniform
        self.moving, self._programs = moving, dict[Any, Program]()

    def program(self, of: Any) -> Program:
        """What computes "value" (rows [k]), "response" (the value and its derivatives by all that moves, rows
        [1 + components, k]), or the derivative by the input of this name (rows [k]).
        """
        if of not in self._programs:
            moved_by: list[Any] = [(name, place) for name, n in self.moving.items() for place in range(n)]
            by: list[Any] = [] if of == "value" else moved_by if of == "response" else [of]
            outputs = list(self._outputs) if of in ("value", "response") else []
            for name in by:
                outputs += self._graph.derivatives(self._outputs, self._graph.input(name))
            self._programs[of] = Program(list(enumerate(outputs)), self._is_uniform)
        return self._programs[of]

    def _is_uniform(self, name: tuple[Any, int]) -> bool:
        return isinstance(name[0], tuple) or name[0] in self._uniform


def alike(laws: Sequence[Law | None]) -> list[Law | None]:
    """The laws of several lanes, if they differ in nothing but constants. Raises NotTraceableError where they do."""
    known = [law for law in laws if law is not None]
    for law in known:
        if law is not known[0] and not law.program("response").same_but_for_constants(
            known[0].program("response")
        ):
            raise NotTraceableError("the lanes compute differently")
    return list(laws)


def _outputs(
    effect: Effect, method: str, at: SiteState | MaterialPoints, p: SimpleNamespace, count: int, graph: Graph
) -> list[Node]:
    """What the method returns for one point. Raises NotTraceableError where it does what cannot be recorded."""
    try:
        with np.errstate(all="ignore"):
            found = np.asarray(getattr(effect, method)(at, p), dtype=object).reshape(-1)
    except NotTraceableError:
        raise
    except Exception as error:
        raise NotTraceableError(f"recording it fails ({type(error).__name__}: {error})") from error
    if len(found) != count:
        raise NotTraceableError("its answer at one point has another shape than at several")
    found = [x.item() if isinstance(x, np.ndarray) else x for x in found]
    return [x if isinstance(x, Node) else graph.constant(x) for x in found]


def _parameters(graph: Graph, effect: Effect) -> SimpleNamespace:
    return SimpleNamespace(**{p.name: Traced.of(graph.input((("p", p.name), 0))) for p in effect.parameters})


def _recorded(
    effect: ForceEffect | MaterialEffect,
    method: str,
    k: int,
    moving: Mapping[str, int],
    uniform: Sequence[str],
    shapes: Mapping[str, tuple[int, ...]],
    points: Callable[[dict[str, Any]], Any],
) -> Law:
    """The law that a method computes, once it was seen to give what the method gives at random states.

    shapes: of what a single point is given, with first axis 1 where it is one row of many; points: the argument of the
    method made of these.
    """
    graph = Graph()
    given = {name: Traced.inputs(graph, name, shape) for name, shape in shapes.items()}
    law = Law(
        graph,
        _outputs(effect, method, points(given), _parameters(graph, effect), k, graph),
        {name: count for name, count in moving.items() if name in effect.depends_on},
        frozenset(uniform),
    )
    random = np.random.default_rng(0).standard_normal
    states: dict[str, Any] = {}
    for name, shape in shapes.items():
        drawn = random((_STATES, *shape[1:]) if shape[:1] == (1,) and name not in uniform else shape)
        states[name] = np.asarray(_USUAL[name][0]) + _USUAL[name][1] * drawn
    p = SimpleNamespace(**effect.typical())
    with np.errstate(all="ignore"):
        expected = np.asarray(getattr(effect, method)(points(states), p), dtype=float).reshape(_STATES, k)

    def value(name: tuple[Any, int]) -> np.ndarray | float:
        if isinstance(name[0], tuple):
            return getattr(p, name[0][1])
        state = np.asarray(states[name[0]])
        return state.ravel()[name[1]] if name[0] in uniform else state.reshape(_STATES, -1)[:, name[1]]

    found = law.program("value").run(value, _STATES, k).T
    if not np.allclose(found, expected, rtol=1e-12, atol=1e-12 * np.abs(expected).max(), equal_nan=True):
        raise NotTraceableError("recorded at one point it gives other numbers than at several")
    return law


@lru_cache(maxsize=512)
def force_law(
    effect: ForceEffect,
    method: str,
    muscles: int,
    gravity: tuple[float, float],
    surroundings: Surroundings | None,
) -> Law:
    """The law of a force or a flux. Raises NotTraceableError."""
    shapes: dict[str, tuple[int, ...]] = {
        **dict.fromkeys((*OF_THE_SITES, "reference", "rest_normal"), (1, 2)),
        "measure": (1,),
        "voltage": (muscles,),
        "contraction": (muscles,),
        "time": (),
    }

    def points(given: dict[str, Any]) -> SiteState:
        return SiteState(**given, gravity=np.array(gravity), surroundings=surroundings)

    uniform = ("voltage", "contraction", "time")
    return _recorded(effect, method, 2, dict.fromkeys(OF_THE_SITES, 2), uniform, shapes, points)


@lru_cache(maxsize=512)
def stress_law(effect: MaterialEffect) -> Law:
    """The law of a further stress. Raises NotTraceableError."""
    shapes: dict[str, tuple[int, ...]] = {
        **dict.fromkeys(("deformation", "rate"), (1, 2, 2)),
        **dict.fromkeys(("contraction", "voltage", "fibre", "shear"), (1,)),
        "time": (),
    }

    def points(given: dict[str, Any]) -> MaterialPoints:
        return MaterialPoints(**given)

    moving = {"deformation": 4, "rate": 4}
    return _recorded(effect, "first_piola", 4, moving, ("time",), shapes, points)
