"""Checks of a force effect: known sites, null, response, locality, and that it says what it depends on."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import ForceEffect, SiteState, Surroundings
from hasel_sim.effects.check_tools import called, check_depends_on, expect, same

_SITES = ("body", "skin", "line", "points")
_QUANTITIES = ("position", "velocity", "acceleration", "tangent", "tangent_rate")


def check_force(effect: ForceEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    """Refuse a force effect that breaks a rule, with a ModelError."""
    expect(
        effect.sites in _SITES, effect, f"acts at sites '{effect.sites}'", f"use one of {', '.join(_SITES)}"
    )
    known = (*_QUANTITIES, "contraction")
    check_depends_on(effect, known)
    at = _example(effect)
    if effect.sites == "points":
        markers = np.array([[0.005, 0.0], [0.094, 0.0], [0.19, 0.0]])
        count = len(np.atleast_2d(np.asarray(effect.points(markers, typical), dtype=float)))
        called(effect, "points", (count, 2), markers, typical)
    expect(
        effect.sites == "line" or not effect.has_flux,
        effect,
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
    shape = at.position.shape
    off, on = called(effect, method, shape, at, null), called(effect, method, shape, at, typical)
    expect(
        not np.any(off), effect, f"exerts a {method} at its null values", f"make {method} return zeros there"
    )
    expect(
        np.any(on), effect, f"exerts no {method} at its typical values", f"make {method} use its parameters"
    )
    few = called(effect, method, (2, 2), _rows(at, 2), typical)
    expect(
        same(few, on[:2]),
        effect,
        f"exerts a {method} at one place that depends on others",
        f"compute every row of the {method} from the same row of positions, velocities and so on only",
    )
    rng = np.random.default_rng(2)
    for name in set(known) - set(effect.depends_on):
        value = getattr(at, name)
        moved = replace(at, **{name: value + 0.1 * rng.standard_normal(value.shape)})
        expect(
            same(called(effect, method, shape, moved, typical), on),
            effect,
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
    names = (*_QUANTITIES, "reference", "rest_normal", "measure")
    return replace(at, **{name: getattr(at, name)[:count] for name in names})
