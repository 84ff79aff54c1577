"""The law of an effect, recorded at one point: its value, and what it changes with the motion or with a parameter."""

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
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
from hasel_sim.tape.expressions import Graph, Node
from hasel_sim.tape.program import Program
from hasel_sim.tape.tracing import NotTraceableError, Traced

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

    def _is_uniform(self, name: tuple) -> bool:
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


def _outputs(effect, method: str, at, p: SimpleNamespace, count: int, graph: Graph) -> list[Node]:
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

    def value(name: tuple) -> np.ndarray | float:
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
