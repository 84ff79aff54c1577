"""From a model to a mechanical system, and to the derivative of its residual by each parameter."""

from dataclasses import replace
from functools import lru_cache
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import Coefficients, Effect, EffectParameter, ForceEffect, MaterialEffect
from hasel_sim.errors import ModelError
from hasel_sim.first_run import announce_compilation
from hasel_sim.mechanics.branches import Branches
from hasel_sim.mechanics.force_law import ForceLaw
from hasel_sim.mechanics.inertia import Mass, element_masses
from hasel_sim.mechanics.residual_slopes import (
    ForceSlope,
    NoSlope,
    ResidualSlope,
    SolidSlope,
    StressSlope,
    SystemSlope,
)
from hasel_sim.mechanics.solid import Solid, lame_constants
from hasel_sim.mechanics.stress_law import StressLaw
from hasel_sim.mechanics.system import System
from hasel_sim.mesh.bodies import outline_fault, rectangle_mesh, swimmer_mesh
from hasel_sim.mesh.mesh import Mesh, Region
from hasel_sim.mesh.serendipity import reference_gradients
from hasel_sim.mesh.sites import Sites, body_sites, point_sites, skin_sites
from hasel_sim.model import Model
from hasel_sim.model.description import RectangleBody, SwimmerBody

_OUTLINE_STEP = 3e-6
"""Step [1] of the central differences by an outline coefficient."""


@lru_cache(maxsize=16)
def body_mesh(body: SwimmerBody | RectangleBody, density: float) -> Mesh:
    """The mesh of a described body. Raises ModelError when the outline crosses the spine or itself."""
    if body.kind == "rectangle":
        aspect = body.length_m / body.height_m
        through = max(1, round(2 * density))
        return rectangle_mesh(
            length=body.length_m,
            height=body.height_m,
            clamped=body.clamped,
            elements_along=max(2, round(2 * aspect * through))
            if aspect < 20
            else max(8, round(24 * density)),
            elements_through=through,
        )
    outline = np.array(body.outline_coefficients)
    fault = outline_fault(outline, body.largest_half_height_m, body.spine_thickness_m, body.body_length_m)
    if fault:
        raise ModelError(fault)
    return swimmer_mesh(
        body_length=body.body_length_m,
        fin_length=body.fin_length_m,
        spine_thickness=body.spine_thickness_m,
        largest_half_height=body.largest_half_height_m,
        outline=outline,
        head_length=body.head_length_m,
        muscle_end=body.muscle_end_m,
        density=density,
    )


def model_mesh(model: Model) -> Mesh:
    """The mesh of a model."""
    return body_mesh(model.description.body, model.description.numerics.mesh_density)


def marker_points(model: Model) -> np.ndarray:
    """Reference positions [m] of head, middle and tail marker, [3, 2]."""
    markers = model.description.markers
    return np.array([[marker.x_m, 0.0] for marker in (markers.head, markers.middle, markers.tail)])


def _material(model: Model, mesh: Mesh, nodes: np.ndarray) -> tuple[Coefficients, np.ndarray]:
    description = model.description
    spine = mesh.region == Region.SPINE
    soft_material, spine_material = (
        description.material.soft,
        description.material.spine or description.material.soft,
    )

    def choose(soft: float, stiff: float) -> np.ndarray:
        return np.where(spine, stiff, soft)

    pairs = [lame_constants(m.youngs_modulus_pa, m.poissons_ratio) for m in (soft_material, spine_material)]
    values, _, areas = reference_gradients(nodes[mesh.elements], description.numerics.quadrature_order)
    coefficients = Coefficients(
        shear=choose(pairs[0][0], pairs[1][0]),
        lame=choose(pairs[0][1], pairs[1][1]),
        equilibrium=np.ones(len(spine)),
        retardation=choose(soft_material.retardation_time_s, spine_material.retardation_time_s),
        fibre=np.full(len(spine), description.muscle.fibre_stiffness_pa if description.muscle else 0.0),
        region=mesh.region,
        rest_stretch=np.ones(areas.shape),
        height=np.einsum("ga,ea->eg", values, nodes[mesh.elements][..., 1]),
    )
    return coefficients, choose(soft_material.density_kg_per_m3, spine_material.density_kg_per_m3)


class Builder:
    """Builds the system of a model at its parameter values, on the model's mesh or on moved nodes [m] [nodes, 2]."""

    def __init__(self, model: Model, nodes: np.ndarray | None = None) -> None:
        announce_compilation()
        self.model = model
        self.mesh = model_mesh(model) if nodes is None else replace(model_mesh(model), nodes=nodes)
        self.nodes = self.mesh.nodes
        _, self._density = _material(model, self.mesh, self.nodes)
        self.mass = Mass(self.mesh, element_masses(self.mesh, self.nodes, self._density))
        self._values = model.effect_values()

    def system(self) -> System:
        """The mechanical system at the model's values."""
        gravity = np.array(self.model.description.material.gravity_m_per_s2)
        forces = [self._force_law(e, self._values[e.id]) for e in self._of(ForceEffect)]
        stresses = [self._stress_law(e, self._values[e.id]) for e in self._of(MaterialEffect) if e.regions]
        return System(self.mesh, self.nodes, self._solid(self._values), self.mass, gravity, forces, stresses)

    def _of(self, kind: type[Effect]) -> list:
        """Effects of one kind, in an order that the model file has no part in."""
        found = [effect for effect in self.model.effects if isinstance(effect, kind)]
        return sorted(found, key=lambda effect: effect.id)

    def _solid(self, values: dict[str, SimpleNamespace]) -> Solid:
        coefficients, _ = _material(self.model, self.mesh, self.nodes)
        branches = []
        for effect in self._of(MaterialEffect):
            effect.modify(coefficients, values[effect.id])
            branches += effect.branches(values[effect.id])
        plane_stress = self.model.description.material.plane == "stress"
        order = self.model.description.numerics.quadrature_order
        return Solid(self.mesh, self.nodes, coefficients, Branches(branches), plane_stress, order)

    def _sites(self, effect: ForceEffect, p: SimpleNamespace) -> Sites:
        if effect.sites == "body":
            return body_sites(self.mesh, self.nodes, self._density)
        if effect.sites == "skin":
            return skin_sites(self.mesh)
        return point_sites(self.mesh, effect.points(marker_points(self.model), p))

    def _force_law(self, effect: ForceEffect, p: SimpleNamespace) -> ForceLaw:
        gravity = self.model.description.material.gravity_m_per_s2
        return ForceLaw(effect, p, self._sites(effect, p), self.nodes, gravity)

    def _stress_law(self, effect: MaterialEffect, p: SimpleNamespace) -> StressLaw:
        muscle = np.where(self.mesh.region >= Region.UPPER_MUSCLE, self.mesh.region - 1, 0)
        muscles = self.model.description.muscle
        fibre = muscles.fibre_stiffness_pa if muscles else 0.0
        return StressLaw(effect, p, self.mesh.region, muscle, fibre)

    def residual_slope(self, name: str) -> ResidualSlope:
        """The derivative of the residual by one of the model's parameters."""
        identity, _, own = name.rpartition(".")
        effect = next((effect for effect in self.model.effects if effect.id == identity), None)
        if effect is None or not isinstance(effect, ForceEffect | MaterialEffect):
            return NoSlope()
        parameter = next(p for p in effect.parameters if p.name == own)
        more, less, width = difference_points(parameter, getattr(self._values[identity], own))
        above, below = (
            SimpleNamespace(**{**vars(self._values[identity]), own: value}) for value in (more, less)
        )
        if isinstance(effect, ForceEffect):
            return ForceSlope(self._force_law(effect, above), self._force_law(effect, below), width)
        if effect.regions:
            return StressSlope(self._stress_law(effect, above), self._stress_law(effect, below), width)
        solids = [self._solid({**self._values, identity: changed}) for changed in (above, below)]
        return SolidSlope(*solids, width)

    def outline_slope(self, index: int) -> ResidualSlope:
        """The derivative of the residual by one outline coefficient, which moves nodes, masses, skin and all."""
        shift = _OUTLINE_STEP * self.mesh.outline_slope[index]
        systems = [Builder(self.model, self.nodes + sign * shift).system() for sign in (1.0, -1.0)]
        return SystemSlope(*systems, 2 * _OUTLINE_STEP)


def difference_points(parameter: EffectParameter, value: float) -> tuple[float, float, float]:
    """Two values around `value`, within the parameter's range, and their distance."""
    more = value + parameter.step if value + parameter.step <= parameter.upper else value
    less = value - parameter.step if value - parameter.step >= parameter.lower else value
    return more, less, more - less
