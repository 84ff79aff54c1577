# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""Checks of force and material effects: null, response, locality, sound constants, and what they say they depend on."""

from dataclasses import replace
from functools import partial
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import (
    Coefficients,
    ForceEffect,
    MaterialEffect,
    MaterialPoints,
    SiteState,
    Surroundings,
    guarded,
)
from hasel_sim.effects.check_tools import called, check_depends_on, expect, repeatable, same
from hasel_sim.mesh.mesh import Region

_SITES = ("body", "skin", "line", "points")
_MOTION = ("position", "velocity", "acceleration", "tangent", "tangent_rate")


def check_force(effect: ForceEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    """Refuse a force effect that breaks a rule, with a ModelError."""
    must = partial(expect, effect)
    must(effect.sites in _SITES, f"acts at sites '{effect.sites}'", f"use one of {', '.join(_SITES)}")
    known = (*_MOTION, "contraction")
    check_depends_on(effect, known)
    at = _example(effect)
    if effect.sites == "points":
        markers = np.array([[0.005, 0.0], [0.094, 0.0], [0.19, 0.0]])
        count = len(np.atleast_2d(np.asarray(effect.points(markers, typical), dtype=float)))
        called(effect, "points", (count, 2), markers, typical)
    must(
        effect.sites == "line" or not effect.has_flux,
        f"has a flux at sites '{effect.sites}'",
        'use sites = "line", along which a flux can be handed on',
    )
    for method in ("force", "flux") if effect.has_flux else ("force",):
        _check_response(effect, method, at, null, typical, known)


def _check_response(
    effect: ForceEffect,
    method: str,
    at: SiteState,
    null: SimpleNamespace,
    typical: SimpleNamespace,
    known: tuple[str, ...],
) -> None:
    """Refuse a force, or flux, that is not null at null, does nothing, or depends on what it does not say."""
    must = partial(expect, effect)
    shape = at.position.shape
    off, on = called(effect, method, shape, at, null), called(effect, method, shape, at, typical)
    must(not np.any(off), f"exerts a {method} at its null values", f"make {method} return zeros there")
    must(np.any(on), f"exerts no {method} at its typical values", f"make {method} use its parameters")
    few = called(effect, method, (2, 2), _rows(at, 2), typical)
    must(
        same(few, on[:2]),
        f"exerts a {method} at one place that depends on others",
        f"compute every row of the {method} from the same row of positions, velocities and so on only",
    )
    rng = np.random.default_rng(2)
    for name in set(known) - set(effect.depends_on):
        value = getattr(at, name)
        moved = replace(at, **{name: value + 0.1 * rng.standard_normal(value.shape)})
        must(
            same(called(effect, method, shape, moved, typical), on),
            f"uses the {name} without saying so",
            f'add "{name}" to depends_on',
        )


def _example(effect: ForceEffect) -> SiteState:
    rng, n = np.random.default_rng(1), 7
    reference = np.stack([np.linspace(0.01, 0.18, n), 0.005 * (-1.0) ** np.arange(n)], axis=1)
    along = np.stack([np.ones(n), np.zeros(n)], axis=1) * (effect.sites in ("skin", "line"))
    return SiteState(
        position=reference + 0.01 * rng.standard_normal((n, 2)),
        velocity=0.2 * rng.standard_normal((n, 2)),
        acceleration=2.0 * rng.standard_normal((n, 2)),
        tangent=along + 0.1 * rng.standard_normal((n, 2)),
        tangent_rate=3.0 * rng.standard_normal((n, 2)),
        reference=reference,
        rest_normal=along @ np.array([[0.0, -1.0], [1.0, 0.0]]),
        measure=np.full(n, 0.01),
        voltage=np.array([5000.0, -3000.0]),
        contraction=np.array([0.05, 0.02]),
        time=0.3,
        gravity=np.array([0.0, -9.81]),
        surroundings=Surroundings(920.0, 0.07, 0.05, 0.19) if effect.needs_medium else None,
    )


def _rows(at: SiteState, count: int) -> SiteState:
    names = (*_MOTION, "reference", "rest_normal", "measure")
    return replace(at, **{name: getattr(at, name)[:count] for name in names})


_OF_CONSTANTS = ("modify", "branches", "fading")
_OF_STRESS = ("deformation", "rate")


def check_material(effect: MaterialEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    """Refuse a material effect that breaks a rule, with a ModelError."""
    must = partial(expect, effect)
    if effect.regions:
        kind = type(effect)
        plain = all(getattr(kind, name) is getattr(MaterialEffect, name) for name in _OF_CONSTANTS)
        must(plain, "adds stress and changes constants", "make two effects of it")
        _check_stress(effect, null, typical)
    else:
        _check_constants(effect, null, typical)


def _check_stress(effect: MaterialEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    must = partial(expect, effect)
    known = all(region in tuple(Region) for region in effect.regions)
    must(known, f"names the regions {effect.regions}", "use members of Region")
    rng, n = np.random.default_rng(1), 6
    turns = 1.0 + 0.05 * np.linspace(-1.0, 1.0, n)
    parts = {
        "deformation": np.eye(2) * turns[:, None, None] + 0.02 * rng.standard_normal((n, 2, 2)),
        "rate": rng.standard_normal((n, 2, 2)),
        "contraction": np.linspace(0.0, 0.06, n),
        "voltage": np.linspace(0.0, 5000.0, n),
    }
    parts["fibre"], parts["shear"] = np.full(n, 65e3), np.full(n, 22e3)
    at = MaterialPoints(**parts, time=0.3)
    few = MaterialPoints(**{name: part[:2] for name, part in parts.items()}, time=0.3)
    off = called(effect, "first_piola", (n, 2, 2), at, null)
    on = called(effect, "first_piola", (n, 2, 2), at, typical)
    check_depends_on(effect, _OF_STRESS)
    for name in set(_OF_STRESS) - set(effect.depends_on):
        moved = replace(at, **{name: parts[name] + 0.01 * rng.standard_normal((n, 2, 2))})  # type: ignore[arg-type]
        must(
            same(called(effect, "first_piola", (n, 2, 2), moved, typical), on),
            f"uses the {name} without saying so",
            f'add "{name}" to depends_on',
        )
    must(not np.any(off), "adds stress at its null values", "make first_piola return zeros there")
    must(np.any(on), "adds no stress at its typical values", "make first_piola use its parameters")
    must(
        same(called(effect, "first_piola", (2, 2, 2), few, typical), on[:2]),
        "adds a stress at one place that depends on others",
        "compute every row of first_piola from the same row of the deformation only",
    )


def _check_constants(effect: MaterialEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    must = partial(expect, effect)
    before, off, on, again = _constants(), _constants(), _constants(), _constants()
    for constants, p in ((off, null), (on, typical), (again, typical)):
        returned = guarded(effect, "modify", constants, p)
        must(returned is None, "returns something from modify", "change the arrays in place (x[:] = ...)")
        for name, value in vars(before).items():
            found = np.asarray(getattr(constants, name))
            sound = found.shape == value.shape and np.isfinite(found).all()
            must(sound, f"leaves '{name}' with a wrong shape or no number", "change the arrays in place")
        stiff = (
            np.all(constants.shear > 0)
            and np.all(constants.rest_stretch > 0)
            and np.all(constants.retardation >= 0)
        )
        must(stiff, "makes shear, rest_stretch or retardation negative", "keep them above zero")
    repeated = all(same(getattr(again, name), value) for name, value in vars(on).items())
    repeatable(effect, "modify", repeated)
    quiet, loud = (_moduli_and_shares(effect, p) for p in (null, typical))
    unchanged = [same(getattr(off, name), value) for name, value in vars(before).items()]
    must(
        all(unchanged) and not any(ratio for ratio, _ in quiet),
        "changes the material at its null values",
        "make modify change nothing and every branch have the ratio or share 0 there",
    )
    must(len(quiet) == len(loud), "changes its number of branches", "return the same branches at any values")
    times = np.array([time for _, time in loud])
    must(np.all(times > 0), "has a branch without relaxation time", "give every branch a time above 0 s")
    kept = [same(getattr(on, name), value) for name, value in vars(before).items()]
    must(
        not all(kept) or any(ratio for ratio, _ in loud),
        "does nothing at its typical values",
        "write modify, branches, fading, or regions with first_piola",
    )


def _moduli_and_shares(effect: MaterialEffect, p: SimpleNamespace) -> list[tuple[float, float]]:
    """Size and time of everything that relaxes."""
    return [*guarded(effect, "branches", p), *guarded(effect, "fading", p)]


def _constants() -> Coefficients:
    region = np.array([int(region) for region in Region])
    return Coefficients(
        shear=np.full(4, 22e3),
        lame=np.full(4, 2e5),
        equilibrium=np.ones(4),
        retardation=np.full(4, 0.02),
        fibre=np.full(4, 65e3),
        region=region,
        rest_stretch=np.ones((4, 9)),
        height=np.tile(np.linspace(-0.007, 0.007, 9), (4, 1)),
    )
