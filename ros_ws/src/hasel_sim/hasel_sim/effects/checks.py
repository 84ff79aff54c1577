"""What is asked of an effect before it may act: declarations, null is null, a response, finite values, right shapes."""

import math
from collections.abc import Callable
from numbers import Real
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import (
    DriveEffect,
    Effect,
    EffectParameter,
    ForceEffect,
    MaterialEffect,
    ObservationEffect,
)
from hasel_sim.effects.check_drive import check_drive
from hasel_sim.effects.check_force import check_force
from hasel_sim.effects.check_material import check_material
from hasel_sim.effects.check_tools import called, expect, same
from hasel_sim.effects.units import is_unit


def check_effect(effect: Effect) -> None:
    """Refuse an effect that does not keep to the rules of its place, with a ModelError that says what to change."""
    _check_declarations(effect)
    null, typical = SimpleNamespace(**effect.null()), SimpleNamespace(**effect.typical())
    checks: dict[type[Effect], Callable] = {
        DriveEffect: check_drive,
        ForceEffect: check_force,
        MaterialEffect: check_material,
        ObservationEffect: _check_observation,
    }
    next(check for place, check in checks.items() if isinstance(effect, place))(effect, null, typical)


def _check_declarations(effect: Effect) -> None:
    for name in ("physics", "equation"):
        text = getattr(effect, name, "")
        expect(isinstance(text, str) and text, effect, f"has no {name}", f'add {name} = "..." to the class')
    parameters = getattr(effect, "parameters", ())
    expect(
        not isinstance(parameters, EffectParameter),
        effect,
        "declares one parameter where a tuple of them is expected",
        "end it with a comma: parameters = (EffectParameter(…),)",
    )
    right = isinstance(parameters, tuple) and all(isinstance(p, EffectParameter) for p in parameters)
    expect(
        right and parameters,
        effect,
        "declares no parameters",
        "add parameters = (EffectParameter(name, symbol, unit, null, lower, upper, typical),)",
    )
    for p in parameters:
        where = f"declares the parameter '{p.name}'"
        plain = isinstance(p.name, str) and p.name.isidentifier()
        expect(plain, effect, where, "use a name of letters, digits and underscores")
        expect(p.unit, effect, f"{where} without unit", 'give its SI unit, or "1" for none')
        expect(
            isinstance(p.unit, str) and is_unit(p.unit),
            effect,
            f"{where} in '{p.unit}', which is no unit",
            "give SI units such as s, Pa, 1/s, kg/m^3 or N s/m, or 1 for none",
        )
        for name in ("null", "lower", "upper", "typical", "difference"):
            value = getattr(p, name)
            expect(
                _is_number(value),
                effect,
                f"{where} with {name}={value!r}, where a number is expected",
                "give one",
            )
        expect(
            isinstance(p.scan, tuple) and all(map(_is_number, p.scan)),
            effect,
            f"{where} with scan={p.scan!r}, where a tuple of numbers is expected",
            "give the values from which fits begin, such as (0.01, 0.1)",
        )
        inside = p.lower <= p.null <= p.upper and p.lower <= p.typical <= p.upper
        expect(
            inside and p.lower < p.upper,
            effect,
            f"{where} with null {p.null:g} and typical {p.typical:g} outside {p.lower:g} to {p.upper:g}",
            "widen the plausible range or correct the values",
        )
    switched = [p for p in parameters if not p.scan and p.typical != p.null]
    expect(
        switched,
        effect,
        "has no parameter that is typically off its null",
        "give one a typical value other than null",
    )


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and math.isfinite(value)


def _check_observation(effect: ObservationEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    time = np.linspace(0.0, 1.0, 241)
    angle = 0.3 * np.sin(2 * np.pi * 2.3 * time)
    markers = np.zeros((len(time), 3, 2))
    markers[:, :, 0] = [0.005, 0.094, 0.190]
    markers[:, 2, 1] = 0.096 * angle
    across = np.stack([-0.2 * np.stack([angle] * 3, axis=1), np.ones((len(time), 3))], axis=2)

    def result(p: SimpleNamespace) -> tuple[np.ndarray, np.ndarray]:
        ahead = effect.look_ahead(p)
        expect(
            np.isfinite(ahead) and ahead >= 0,
            effect,
            f"looks {ahead} s ahead",
            "make look_ahead return 0 or more",
        )
        seen = called(effect, "markers", markers.shape, markers, across, p)
        return seen, called(effect, "angle", time.shape, time, angle, p)

    (seen, measured), (seen_typical, measured_typical) = result(null), result(typical)
    so_far, known = time <= 0.5, time <= 0.6 + effect.look_ahead(typical)
    stopped = called(effect, "angle", time.shape, time, np.where(known, angle, 0.0), typical)
    expect(
        same(stopped[so_far], measured_typical[so_far]),
        effect,
        "shows what is seen later than look_ahead says",
        "compute every row of angle from that row and the rows before it, or return from look_ahead how far ahead [s] "
        "it looks",
    )
    expect(
        same(seen, markers) and same(measured, angle),
        effect,
        "changes what is observed at its null values",
        "make markers and angle return what they get when every parameter is at null",
    )
    expect(
        not (same(seen_typical, markers) and same(measured_typical, angle)),
        effect,
        "does nothing at its typical values",
        "make markers or angle use its parameters, or raise the typical values",
    )
