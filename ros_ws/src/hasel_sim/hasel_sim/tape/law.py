"""The law of an effect, recorded at one point: its value, and what it changes with the motion or with a parameter."""

from collections.abc import Hashable, Sequence
from functools import lru_cache
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import ForceEffect, MaterialEffect, MaterialPoints, SiteState, Surroundings
from hasel_sim.tape.expressions import Graph, Node
from hasel_sim.tape.program import Program
from hasel_sim.tape.tracing import NotTraceableError, Traced

OF_THE_SITES = ("position", "velocity", "acceleration", "tangent", "tangent_rate")
_FIXED_AT_SITES = {"reference": (1, 2), "rest_normal": (1, 2), "measure": (1,)}
_FIXED_AT_POINTS = {"fibre": (1,), "shear": (1,)}


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
        self.moving, self._programs = moving, dict[Hashable, Program]()

    def program(self, of: Hashable) -> Program:
        """What computes "value" (rows [k]), "response" (the value and its derivatives by all that moves, rows
        [1 + components, k]), or the derivative by the input of this name (rows [k]).
        """
        if of not in self._programs:
            by = [(name, place) for name, count in self.moving.items() for place in range(count)]
            by = {"value": [], "response": by}.get(of, [of])
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
    except Exception as error:  # noqa: BLE001  what a method does with arrays that are no plain ones may fail anyhow
        raise NotTraceableError(f"recording it fails ({type(error).__name__}: {error})") from error
    if len(found) != count:
        raise NotTraceableError("its answer at one point has another shape than at several")
    found = [x.item() if isinstance(x, np.ndarray) else x for x in found]
    return [x if isinstance(x, Node) else graph.constant(x) for x in found]


def _parameters(graph: Graph, effect) -> SimpleNamespace:
    return SimpleNamespace(**{p.name: Traced.of(graph.input((("p", p.name), 0))) for p in effect.parameters})


@lru_cache(maxsize=512)
def force_law(
    effect: ForceEffect,
    method: str,
    muscles: int,
    gravity: tuple[float, float],
    surroundings: Surroundings | None,
) -> Law:
    """The law of a force or a flux. Raises NotTraceableError."""
    graph = Graph()
    names = {name: (1, 2) for name in OF_THE_SITES} | _FIXED_AT_SITES
    names |= {"voltage": (muscles,), "contraction": (muscles,), "time": ()}
    given = {name: Traced.inputs(graph, name, shape) for name, shape in names.items()}
    at = SiteState(**given, gravity=np.array(gravity), surroundings=surroundings)
    outputs = _outputs(effect, method, at, _parameters(graph, effect), 2, graph)
    moving = {name: 2 for name in OF_THE_SITES if name in effect.depends_on}
    return Law(graph, outputs, moving, frozenset(("voltage", "contraction", "time")))


@lru_cache(maxsize=512)
def stress_law(effect: MaterialEffect) -> Law:
    """The law of a further stress. Raises NotTraceableError."""
    graph = Graph()
    names = {"deformation": (1, 2, 2), "rate": (1, 2, 2), "contraction": (1,), "voltage": (1,), "time": ()}
    given = {name: Traced.inputs(graph, name, shape) for name, shape in (names | _FIXED_AT_POINTS).items()}
    outputs = _outputs(effect, "first_piola", MaterialPoints(**given), _parameters(graph, effect), 4, graph)
    moving = {name: 4 for name in ("deformation", "rate") if name in effect.depends_on}
    return Law(graph, outputs, moving, frozenset(("time",)))
