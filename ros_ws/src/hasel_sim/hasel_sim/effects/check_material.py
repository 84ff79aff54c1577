"""Checks of a material effect: either a stress or changed constants; null, response, locality, sound constants."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import Coefficients, MaterialEffect, MaterialPoints
from hasel_sim.effects.check_tools import called, check_depends_on, expect, repeatable, same
from hasel_sim.effects.guarded import guarded
from hasel_sim.mesh.mesh import Region

_OF_CONSTANTS = ("modify", "branches", "fading")
_QUANTITIES = ("deformation", "rate")


def check_material(effect: MaterialEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    """Refuse a material effect that breaks a rule, with a ModelError."""
    if effect.regions:
        kind = type(effect)
        plain = all(getattr(kind, name) is getattr(MaterialEffect, name) for name in _OF_CONSTANTS)
        expect(plain, effect, "adds stress and changes constants", "make two effects of it")
        _check_stress(effect, null, typical)
    else:
        _check_constants(effect, null, typical)


def _check_stress(effect: MaterialEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    known = all(region in tuple(Region) for region in effect.regions)
    expect(known, effect, f"names the regions {effect.regions}", "use members of Region")
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
    check_depends_on(effect, _QUANTITIES)
    for name in set(_QUANTITIES) - set(effect.depends_on):
        moved = replace(at, **{name: parts[name] + 0.01 * rng.standard_normal((n, 2, 2))})  # type: ignore[arg-type]
        expect(
            same(called(effect, "first_piola", (n, 2, 2), moved, typical), on),
            effect,
            f"uses the {name} without saying so",
            f'add "{name}" to depends_on',
        )
    expect(not np.any(off), effect, "adds stress at its null values", "make first_piola return zeros there")
    expect(np.any(on), effect, "adds no stress at its typical values", "make first_piola use its parameters")
    expect(
        same(called(effect, "first_piola", (2, 2, 2), few, typical), on[:2]),
        effect,
        "adds a stress at one place that depends on others",
        "compute every row of first_piola from the same row of the deformation only",
    )


def _check_constants(effect: MaterialEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    before, off, on, again = _constants(), _constants(), _constants(), _constants()
    for constants, p in ((off, null), (on, typical), (again, typical)):
        returned = guarded(effect, "modify", constants, p)
        expect(
            returned is None,
            effect,
            "returns something from modify",
            "change the arrays in place (x[:] = ...)",
        )
        for name, value in vars(before).items():
            found = np.asarray(getattr(constants, name))
            sound = found.shape == value.shape and np.isfinite(found).all()
            expect(
                sound,
                effect,
                f"leaves '{name}' with a wrong shape or no number",
                "change the arrays in place",
            )
        stiff = (
            np.all(constants.shear > 0)
            and np.all(constants.rest_stretch > 0)
            and np.all(constants.retardation >= 0)
        )
        expect(stiff, effect, "makes shear, rest_stretch or retardation negative", "keep them above zero")
    repeated = all(same(getattr(again, name), value) for name, value in vars(on).items())
    repeatable(effect, "modify", repeated)
    quiet, loud = (_moduli_and_shares(effect, p) for p in (null, typical))
    unchanged = [same(getattr(off, name), value) for name, value in vars(before).items()]
    expect(
        all(unchanged) and not any(ratio for ratio, _ in quiet),
        effect,
        "changes the material at its null values",
        "make modify change nothing and every branch have the ratio or share 0 there",
    )
    expect(
        len(quiet) == len(loud),
        effect,
        "changes its number of branches",
        "return the same branches at any values",
    )
    times = np.array([time for _, time in loud])
    expect(
        np.all(times > 0),
        effect,
        "has a branch without relaxation time",
        "give every branch a time above 0 s",
    )
    kept = [same(getattr(on, name), value) for name, value in vars(before).items()]
    expect(
        not all(kept) or any(ratio for ratio, _ in loud),
        effect,
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
