# Copyright 2026 HASEL swimmer maintainers. SPDX-License-Identifier: Apache-2.0
"""What is asked of an effect before it may act: declarations, null is null, a response, finite values, right shapes."""

import math
from collections.abc import Callable
from functools import partial
from numbers import Real
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
from hasel_sim.effects.check_mechanics import check_force, check_material
from hasel_sim.effects.check_tools import called, expect, is_unit, same


def check_effect(effect: Effect) -> None:
    """Refuse an effect that does not keep to the rules of its place, with a ModelError that says what to change."""
    _check_declarations(effect)
    null, typical = SimpleNamespace(**effect.null()), SimpleNamespace(**effect.typical())
    checks: dict[type[Effect], Callable[..., None]] = {
        DriveEffect: _check_drive,
        ForceEffect: check_force,
        MaterialEffect: check_material,
        ObservationEffect: _check_observation,
    }
    next(check for place, check in checks.items() if isinstance(effect, place))(effect, null, typical)


def _check_declarations(effect: Effect) -> None:
    must = partial(expect, effect)
    for name in ("physics", "equation"):
        text = getattr(effect, name, "")
        must(isinstance(text, str) and text, f"has no {name}", f'add {name} = "..." to the class')
    parameters = getattr(effect, "parameters", ())
    must(
        not isinstance(parameters, EffectParameter),
        "declares one parameter where a tuple of them is expected",
        "end it with a comma: parameters = (EffectParameter(…),)",
    )
    right = isinstance(parameters, tuple) and all(isinstance(p, EffectParameter) for p in parameters)
    must(
        right and parameters,
        "declares no parameters",
        "add parameters = (EffectParameter(name, symbol, unit, null, lower, upper, typical),)",
    )
    for p in parameters:
        where = f"declares the parameter '{p.name}'"
        plain = isinstance(p.name, str) and p.name.isidentifier()
        must(plain, where, "use a name of letters, digits and underscores")
        must(p.unit, f"{where} without unit", 'give its SI unit, or "1" for none')
        must(
            isinstance(p.unit, str) and is_unit(p.unit),
            f"{where} in '{p.unit}', which is no unit",
            "give SI units such as s, Pa, 1/s, kg/m^3 or N s/m, or 1 for none",
        )
        for name in ("null", "lower", "upper", "typical", "difference"):
            value = getattr(p, name)
            must(_is_number(value), f"{where} with {name}={value!r}, where a number is expected", "give one")
        must(
            isinstance(p.scan, tuple) and all(map(_is_number, p.scan)),
            f"{where} with scan={p.scan!r}, where a tuple of numbers is expected",
            "give the values from which fits begin, such as (0.01, 0.1)",
        )
        inside = p.lower <= p.null <= p.upper and p.lower <= p.typical <= p.upper
        must(
            inside and p.lower < p.upper,
            f"{where} with null {p.null:g} and typical {p.typical:g} outside {p.lower:g} to {p.upper:g}",
            "widen the plausible range or correct the values",
        )
    switched = [p for p in parameters if not p.scan and p.typical != p.null]
    must(
        switched,
        "has no parameter that is typically off its null",
        "give one a typical value other than null",
    )


def _is_number(value: object) -> bool:
    return isinstance(value, Real) and math.isfinite(value)


def _check_observation(effect: ObservationEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    must = partial(expect, effect)
    time = np.linspace(0.0, 1.0, 241)
    angle = 0.3 * np.sin(2 * np.pi * 2.3 * time)
    markers = np.zeros((len(time), 3, 2))
    markers[:, :, 0] = [0.005, 0.094, 0.190]
    markers[:, 2, 1] = 0.096 * angle
    across = np.stack([-0.2 * np.stack([angle] * 3, axis=1), np.ones((len(time), 3))], axis=2)

    def result(p: SimpleNamespace) -> tuple[np.ndarray, np.ndarray]:
        ahead = effect.look_ahead(p)
        must(np.isfinite(ahead) and ahead >= 0, f"looks {ahead} s ahead", "make look_ahead return 0 or more")
        seen = called(effect, "markers", markers.shape, markers, across, p)
        return seen, called(effect, "angle", time.shape, time, angle, p)

    (seen, measured), (seen_typical, measured_typical) = result(null), result(typical)
    so_far, known = time <= 0.5, time <= 0.6 + effect.look_ahead(typical)
    stopped = called(effect, "angle", time.shape, time, np.where(known, angle, 0.0), typical)
    must(
        same(stopped[so_far], measured_typical[so_far]),
        "shows what is seen later than look_ahead says",
        "compute every row of angle from that row and the rows before it, or return from look_ahead how far ahead [s] "
        "it looks",
    )
    must(
        same(seen, markers) and same(measured, angle),
        "changes what is observed at its null values",
        "make markers and angle return what they get when every parameter is at null",
    )
    must(
        not (same(seen_typical, markers) and same(measured_typical, angle)),
        "does nothing at its typical values",
        "make markers or angle use its parameters, or raise the typical values",
    )


_PERIOD_S, _STROKES, _LEVELS = 0.5, 4, (5000.0, 4000.0)
_CONTRACTION_PER_VOLT = 1e-5
_DRIVEN = (
    f"driven with {_STROKES} strokes of either muscle, in turn every {_PERIOD_S:g} s, at {_LEVELS[0]:g} and "
    f"{_LEVELS[1]:g} V"
)


def _check_drive(effect: DriveEffect, null: SimpleNamespace, typical: SimpleNamespace) -> None:
    """Refuse a drive effect that breaks a rule, with a ModelError."""
    must = partial(expect, effect)
    must(
        isinstance(effect.stage, DriveStage), f"has the stage {effect.stage!r}", "use a member of DriveStage"
    )
    time, signal = _strokes()
    if effect.stage >= DriveStage.TARGET:
        signal = _CONTRACTION_PER_VOLT * signal

    def result(p: SimpleNamespace, given: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        response = called(effect, "respond", given.shape, time[: len(given)], given, p)
        return response, called(effect, "clock", (len(given),), time[: len(given)], p)

    (response, clock), (moved, later) = result(null, signal), result(typical, signal)
    must(
        same(np.abs(response), np.abs(signal)) and same(clock, time),
        f"changes the signal at its null values ({_DRIVEN})",
        "make respond return the signal, and clock the time, when every parameter is at null",
    )
    must(
        not (same(moved, signal) and same(later, time)),
        f"does nothing at its typical values ({_DRIVEN})",
        "make respond or clock use its parameters, or raise the typical values",
    )
    so_far = len(time) // 2
    stopped = signal.copy()
    stopped[so_far:] = 0.0
    must(
        same(result(typical, stopped)[0][: so_far - 1], moved[: so_far - 1]),
        "answers to what is commanded later",
        "compute every row of respond from that row and the rows before it only",
    )


def _strokes() -> tuple[np.ndarray, np.ndarray]:
    """Times [s] [n], every switch twice, and voltages [V] [n, 2] of strokes of both muscles in turn."""
    switches = _PERIOD_S * np.arange(1, 2 * _STROKES)
    end = _PERIOD_S * 2 * _STROKES
    time = np.sort(np.concatenate([np.linspace(0.0, end, 961), switches]))
    stroke = np.clip(np.searchsorted(switches, time, side="right"), 0, 2 * _STROKES - 1)
    first = np.isin(np.arange(len(time)), np.searchsorted(time, switches, side="left"))
    stroke = np.where(first, stroke - 1, stroke)
    level = np.where(stroke // 2 % 2 == 0, *_LEVELS)
    return time, np.stack([level * (stroke % 2 == 0), level * (stroke % 2 == 1)], axis=1)
