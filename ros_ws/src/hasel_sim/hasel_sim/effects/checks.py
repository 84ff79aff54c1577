"""What is asked of an effect before it may act: declarations, null is null, a response, finite values, right shapes."""

from collections.abc import Callable
from types import SimpleNamespace

import numpy as np

from hasel_sim.effects.base import (
    DriveEffect,
    DriveStage,
    Effect,
    EffectParameter,
    ForceEffect,
    MaterialEffect,
    ObservationEffect,
)
from hasel_sim.effects.check_force import check_force
from hasel_sim.effects.check_material import check_material
from hasel_sim.effects.check_tools import called, expect, same


def check_effect(effect: Effect) -> None:
    """Refuse an effect that does not keep to the rules of its place, with a ModelError that says what to change."""
    _check_declarations(effect)
    null, typical = SimpleNamespace(**effect.null()), SimpleNamespace(**effect.typical())
    checks: dict[type[Effect], Callable] = {
        DriveEffect: _check_drive,
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
    right = isinstance(parameters, tuple) and all(isinstance(p, EffectParameter) for p in parameters)
    expect(
        right and parameters,
        effect,
        "declares no parameters",
        "add parameters = (EffectParameter(name, symbol, unit, null, lower, upper, typical),)",
    )
    for p in parameters:
        where = f"declares the parameter '{p.name}'"
        expect(p.name.isidentifier(), effect, where, "use a name of letters, digits and underscores")
        expect(p.unit, effect, f"{where} without unit", 'give its SI unit, or "1" for none')
        numbers = np.isfinite([p.null, p.lower, p.upper, p.typical]).all()
        expect(
            numbers, effect, f"{where} with a null, bound or typical value that is no number", "give numbers"
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


def _check_drive(effect: DriveEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    expect(
        isinstance(effect.stage, DriveStage),
        effect,
        f"has the stage {effect.stage!r}",
        "use a member of DriveStage",
    )
    time = np.sort(np.concatenate([np.linspace(0.0, 2.0, 481), [0.5, 1.0, 1.5]]))
    late = np.arange(len(time)) >= np.searchsorted(time, 1.0, side="right")
    size = 0.05 if effect.stage >= DriveStage.TARGET else 5000.0
    signal = size * np.stack([~late, 0.8 * late], axis=1)

    def result(p: SimpleNamespace) -> tuple[np.ndarray, np.ndarray]:
        response = called(effect, "respond", time.shape + (2,), time.copy(), signal.copy(), p)
        return response, called(effect, "clock", time.shape, time.copy(), p)

    (response, clock), (moved, later) = result(null), result(typical)
    expect(
        same(np.abs(response), np.abs(signal)) and same(clock, time),
        effect,
        "changes the signal at its null values",
        "make respond return the signal, and clock the time, when every parameter is at null",
    )
    expect(
        not (same(moved, signal) and same(later, time)),
        effect,
        "does nothing at its typical values",
        "make respond or clock use its parameters, or raise the typical values",
    )


def _check_observation(effect: ObservationEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    time = np.linspace(0.0, 1.0, 241)
    angle = 0.3 * np.sin(2 * np.pi * 2.0 * time)
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
        seen = called(effect, "markers", markers.shape, markers.copy(), across.copy(), p)
        return seen, called(effect, "angle", time.shape, time.copy(), angle.copy(), p)

    (seen, measured), (seen_typical, measured_typical) = result(null), result(typical)
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
