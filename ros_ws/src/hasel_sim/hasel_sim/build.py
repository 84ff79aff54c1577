# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""From a model to a mechanical system, and to the derivative of its residual by each parameter."""

from types import SimpleNamespace
from typing import TypeVar

import numpy as np

from hasel_sim.compiled_loops import announce_compilation
from hasel_sim.dynamics.parameter_columns import (
    ContractionSlope,
    ForceSlope,
    LawSlope,
    NoSlope,
    ResidualSlope,
    SolidSlope,
    SystemSlope,
)
from hasel_sim.dynamics.system import System
from hasel_sim.effects.base import Coefficients, Effect, EffectParameter, ForceEffect, MaterialEffect, guarded
from hasel_sim.laws.force_law import ForceLaw
from hasel_sim.laws.stress_law import StressLaw
from hasel_sim.mechanics.branches import Branches
from hasel_sim.mechanics.solid import Mass, Solid, add_tip_plate, element_masses, lame_constants
from hasel_sim.mesh.mesh import Mesh, Region, reference_gradients
from hasel_sim.mesh.sites import (
    Sites,
    body_sites,
    flux_sites,
    line_sites,
    point_sites,
    skin_sites,
    with_point_mass,
)
from hasel_sim.model import Model
from hasel_sim.model.description import Description
from hasel_sim.model.model_parameters import REST_CONTRACTION, constants, outline_names
from hasel_sim.model_mesh import marker_points, model_mesh

_Kind = TypeVar("_Kind", bound=Effect)


def _material(description: Description, mesh: Mesh, nodes: np.ndarray) -> tuple[Coefficients, np.ndarray]:
    spine = description.material.spine or description.material.soft
    used = [description.material.soft, spine, *(region.material for region in description.body.regions)]
    index = np.where(mesh.material > 0, mesh.material + 1, (mesh.region == Region.SPINE).astype(int))

    def choose(values: list[float]) -> np.ndarray:
        return np.array(values)[index]

    pairs = [lame_constants(m.youngs_modulus_pa, m.poissons_ratio) for m in used]
    fibres = np.array([0.0, *(muscle.fibre_stiffness_pa for muscle in description.muscles)])
    values, _, areas = reference_gradients(nodes[mesh.elements], description.numerics.quadrature_order)
    coefficients = Coefficients(
        shear=choose([shear for shear, _ in pairs]),
        lame=choose([lame for _, lame in pairs]),
        equilibrium=np.ones(len(index)),
        retardation=choose([m.retardation_time_s for m in used]),
        fibre=fibres[mesh.muscle],
        region=mesh.region,
        rest_stretch=np.ones(areas.shape),
        height=np.einsum("ga,ea->eg", values, nodes[mesh.elements][..., 1]),
    )
    return coefficients, choose([m.density_kg_per_m3 for m in used])


class Builder:
    """Builds the system of a model at its parameter values."""

    def __init__(self, model: Model) -> None:
        announce_compilation()
        self.model = model
        self.mesh = model_mesh(model)
        self.nodes = self.mesh.nodes
        self._described = model.described
        coefficients, self._density = _material(self._described, self.mesh, self.nodes)
        self._shear = coefficients.shear
        masses = element_masses(self.mesh, self.nodes, self._density)
        plate = self._described.body.tip_plate
        if plate:
            add_tip_plate(masses, self.mesh, plate.mass_kg_per_m, plate.rotary_inertia_kg_m)
        self.mass = Mass(self.mesh, masses)
        self._values = model.effect_values()
        self._known_sites: dict[str, Sites] = {}

    def system(self) -> System:
        """The mechanical system at the model's values."""
        gravity = np.array(self.model.description.material.gravity_m_per_s2)
        forces = [law for e in self._acting(ForceEffect) for law in self._force_laws(e, self._values[e.id])]
        stresses = [
            self._stress_law(e, self._values[e.id]) for e in self._acting(MaterialEffect) if e.regions
        ]
        solid, muscles = self._solid(self._values), len(self._described.muscles)
        return System(self.mesh, self.nodes, solid, self.mass, gravity, forces, stresses, muscles)

    def _of(self, kind: type[_Kind]) -> list[_Kind]:
        """Effects of one kind, in an order that the model file has no part in."""
        found = [effect for effect in self.model.effects if isinstance(effect, kind)]
        return sorted(found, key=lambda effect: effect.id)

    def _acting(self, kind: type[_Kind]) -> list[_Kind]:
        """Those of them that are not at their null."""
        return [e for e in self._of(kind) if not e.is_null_at(self._values[e.id])]

    def _solid(self, values: dict[str, SimpleNamespace]) -> Solid:
        coefficients, _ = _material(self._described, self.mesh, self.nodes)
        branches, fading = [], []
        for effect in self._of(MaterialEffect):
            guarded(effect, "modify", coefficients, values[effect.id])
            branches += guarded(effect, "branches", values[effect.id])
            fading += guarded(effect, "fading", values[effect.id])
        plane_stress = self.model.description.material.plane == "stress"
        order = self.model.description.numerics.quadrature_order
        return Solid(self.mesh, self.nodes, coefficients, Branches(branches, fading), plane_stress, order)

    def _sites(self, effect: ForceEffect, p: SimpleNamespace) -> Sites:
        if effect.sites == "points":
            return point_sites(self.mesh, guarded(effect, "points", marker_points(self.model)[:3], p))
        if effect.sites not in self._known_sites:
            self._known_sites[effect.sites] = self._sites_of_all(effect.sites)
        return self._known_sites[effect.sites]

    def _sites_of_all(self, kind: str) -> Sites:
        """The sites of all effects at the body, the skin or the centre line."""
        if kind == "skin":
            return skin_sites(self.mesh)
        if kind == "line":
            return line_sites(self.mesh)
        plate = self._described.body.tip_plate
        body = body_sites(self.mesh, self.nodes, self._density)
        return body if plate is None else with_point_mass(body, self.mesh, plate.mass_kg_per_m)

    def _force_laws(self, effect: ForceEffect, p: SimpleNamespace) -> list[ForceLaw]:
        """What acts of one effect: its force, and its flux where it has one."""
        gravity = self.model.description.material.gravity_m_per_s2
        around = self._described.surroundings
        muscles = len(self._described.muscles)

        def law(sites: Sites, flux: bool) -> ForceLaw:
            return ForceLaw(effect, p, sites, self.nodes, gravity, around, flux, muscles)

        laws = [law(self._sites(effect, p), False)]
        return [*laws, law(flux_sites(laws[0].sites, effect.sheds), True)] if effect.has_flux else laws

    def _stress_law(self, effect: MaterialEffect, p: SimpleNamespace) -> StressLaw:
        fibres = np.array([0.0, *(muscle.fibre_stiffness_pa for muscle in self._described.muscles)])
        points = self.model.description.numerics.quadrature_order**2
        return StressLaw(effect, p, self.mesh, points, fibres, self._shear)

    def residual_slope(self, name: str) -> ResidualSlope:
        """The derivative of the residual by one of the model's parameters."""
        identity, _, own = name.rpartition(".")
        if name in constants(self.model.description):
            return self._constant_slope(name)
        effect = next((effect for effect in self.model.effects if effect.id == identity), None)
        if effect is None or not isinstance(effect, ForceEffect | MaterialEffect):
            return NoSlope()
        parameter = next(p for p in effect.parameters if p.name == own)
        more, less, width = parameter.around(getattr(self._values[identity], own))
        above, below = (
            SimpleNamespace(**{**vars(self._values[identity]), own: value}) for value in (more, less)
        )
        if isinstance(effect, ForceEffect):
            laws, more_laws, less_laws = (
                self._force_laws(effect, p) for p in (self._values[identity], above, below)
            )
            by_difference = ForceSlope(more_laws, less_laws, width)
            if all(a.sites.same_as(b.sites) for a, b in zip(more_laws, less_laws, strict=True)):
                return LawSlope(laws, own, by_difference)
            return by_difference
        if effect.regions:
            return LawSlope([self._stress_law(effect, self._values[identity])], own)
        more_solid, less_solid = (
            self._solid({**self._values, identity: changed}) for changed in (above, below)
        )
        return SolidSlope(more_solid, less_solid, width)

    def _constant_slope(self, name: str) -> ResidualSlope:
        if name.endswith(REST_CONTRACTION):
            names = [muscle.name for muscle in self.model.description.muscles]
            return ContractionSlope(names.index(name.split(".")[1]))
        more, less, width = constant_parameter(self.model, name).around(self.model.values[name])
        above, below = (Builder(self.model.with_values({name: value})).system() for value in (more, less))
        return SystemSlope(above, below, width)

    def outline_slope(self, index: int) -> ResidualSlope:
        """The derivative of the residual by one outline coefficient, which moves nodes, masses, skin and all."""
        name = outline_names(self.model.description.body)[index]
        return Builder(self.model.with_freed(name)).residual_slope(name)


def constant_parameter(model: Model, name: str) -> EffectParameter:
    """What is known of a freed constant: a difference step that fits its size."""
    p = model.parameter(name)
    typical = abs(p.value) or (p.upper if np.isfinite(p.upper) else 0.0) or 1.0
    return EffectParameter(name, name, p.unit, 0.0, p.lower, p.upper, typical)
