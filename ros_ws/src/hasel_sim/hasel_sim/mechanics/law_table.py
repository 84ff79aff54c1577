"""What all effects of a model add to a step, side by side for the compiled loops of `march`."""

from functools import cached_property

import numpy as np

from hasel_sim.mechanics.force_law import ForceLaw
from hasel_sim.mechanics.law_terms import site_groups
from hasel_sim.mechanics.linearisation import StrainedSystem
from hasel_sim.mechanics.motion import DriveState, Motion
from hasel_sim.mechanics.stress_law import StressLaw
from hasel_sim.mechanics.system import System
from hasel_sim.mechanics.tape_loops import add_slopes, respond
from hasel_sim.mechanics.tapes import BoundLaw, Tapes
from hasel_sim.simd import lane_tuple


class LawTable:
    """Forces and additional stresses of every effect, called at one motion, with their derivatives where wanted.

    terms: nodal forces out of balance [nodes, 2, lanes]; the sites of all force effects (their `SiteGroups`,
    derivatives by the value and by the tangent of the end-of-step acceleration [sites, 2, 2, lanes]); the place of
    every element among those with further stress or -1, and their stress [n, points, 4, lanes] and its derivative
    [n, points, 4, 4, lanes]. Empty where no effect acts; one at its null is not among the laws. by_rate: derivative of
    the further stress by the rate of the deformation [n, points, 4, 4, lanes] alone, of `linearise`. programs, tapes:
    what `tape_loops.respond` takes.
    """

    def __init__(self, system: System) -> None:
        self._system, solid, lanes = system, system.solid, system.lanes
        sites = [(law.sites, law.looks_along) for law in system.forces]
        slopes = np.zeros((2, sum(len(each.nodes) for each, _ in sites), 2, 2, lanes))
        concerned = [law.elements for law in system.stresses]
        elements = np.unique(np.concatenate([np.zeros(0, dtype=np.intp), *concerned]))
        further = np.full(len(solid.elements), -1)
        further[elements] = np.arange(len(elements))
        points = solid.areas.shape[1]
        stress, matrix, self.by_rate = (
            np.zeros((len(elements), points, *n, lanes)) for n in ((4,), (4, 4), (4, 4))
        )
        self.terms = (
            np.zeros((*system.nodes.shape, lanes)),
            (site_groups(sites), slopes[0], slopes[1]),
            (further, stress, matrix),
        )
        self._laws: list[ForceLaw | StressLaw] = [*system.forces, *system.stresses]
        firsts = [0, *np.cumsum([law.points for law in system.forces])][: len(system.forces)]
        firsts += [-1] * len(system.stresses)
        rows = [(2 * n, 2 * n + 1, first) for n, first in enumerate(firsts)]
        self.programs = np.array(rows, dtype=np.intp).reshape(-1, 3)
        wanted: list[tuple[BoundLaw, str]] = [(law, of) for law in self._laws for of in ("value", "response")]
        self.tapes = Tapes(wanted, lanes, system.muscles)

    def __bool__(self) -> bool:
        """Whether there are any effects to call."""
        return bool(self._laws)

    @cached_property
    def as_python(self) -> bool:
        """Whether any of them runs as Python, and must be called before the compiled loops go on."""
        return any(law.laws is None for law in self._laws)

    def python_laws(self) -> dict[str, str]:
        """Names of effects that run as Python, with why they do."""
        as_python = [law for law in self._laws if law.laws is None]
        return {law.effect.source or law.effect.id: law.why_python for law in as_python}

    def call(self, motion: Motion, drive: DriveState, with_slopes: bool, exact: bool = False) -> None:
        """Call every effect that runs as Python once, with its derivatives where wanted."""
        for value, response, _ in self.programs.tolist():
            program = response if with_slopes else value
            self.tapes.fill(program, motion, drive, self._system.solid.places, exact)

    def linearise(self, at: StrainedSystem, drive: DriveState, weights: np.ndarray) -> None:
        """Differentiate every effect; terms as in `tape_loops.respond`, whose weights these are."""
        if not self:
            return
        self.call(at.motion, drive, with_slopes=True, exact=True)
        motion, lane = at.motion, lane_tuple(self._system.lanes)
        fields, places = (motion.position, motion.velocity, motion.acceleration), self._system.solid.places
        tables = self.tapes.tables
        respond(tables, self.programs, True, fields, places, drive.signals, weights, self.terms, lane)
        _, (_, *sites), (further, _, _) = self.terms
        rate_alone = np.array([0.0, 1.0, 0.0])[:, None] * np.ones(self._system.lanes)
        self.by_rate[:] = 0.0
        for law, (_, program, _) in zip(self._laws, self.programs.tolist(), strict=True):
            if isinstance(law, ForceLaw):
                law.keep(self.tapes.rows(program))
                if "contraction" in law.effect.depends_on:
                    law.linearise(motion, drive)
            elif "rate" in law.moving:
                add_slopes(tables, program, -1, further, rate_alone, tuple(sites), self.by_rate, lane)

    def add_pulled_back(self, weights: np.ndarray, rate: np.ndarray, acceleration: np.ndarray) -> None:
        """Add to both [nodes, 2, lanes] the transposed derivatives of the forces out of balance times weights."""
        for law in self._system.forces:
            law.add_pulled_back(weights, (None, rate, acceleration))
