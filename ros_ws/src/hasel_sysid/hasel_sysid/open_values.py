"""Which values of an answer stay open: the effect might do nothing there, since something else can do what it does."""

from collections.abc import Collection

import numpy as np
from hasel_sim.effects.base import Effect
from hasel_sim.model import Model

from hasel_sysid.policy import POLICY

_COLLINEAR = 0.95
"""Correlation of two errors from which what the one value takes the other gives."""


def open_values(model: Model, effects: Collection[str]) -> dict[str, str]:
    """Of these effects of a fitted model those whose intervals all hold the value at which they do nothing, each with a
    sentence: its first size, and the other value that is known only together with it, if there is one.

    Together such effects may be needed all the same: then their sum is known, and not the parts.
    """
    chosen = [effect for effect in model.effects if effect.id in effects]
    return {effect.id: sentence for effect in chosen if (sentence := _open(model, effect))}


def _open(model: Model, effect: Effect) -> str | None:
    sizes = {f"{effect.id}.{p.name}": p.null for p in effect.parameters if not p.scan}
    fitted = {name: null for name, null in sizes.items() if model.parameters[name].free}
    if not fitted or not all(_may_be(model, name, null) for name, null in fitted.items()):
        return None
    name, null = next(iter(fitted.items()))
    unit = "" if model.parameters[name].unit == "1" else f" {model.parameters[name].unit}"
    other, correlation = _closest(model, name, leave_out=sizes)
    instead = f"; {other} can do the same (correlation {correlation:+.2f})" if other else ""
    return f"{name} is not known: its interval holds {null:g}{unit}, at which it does nothing{instead}."


def _may_be(model: Model, name: str, value: float) -> bool:
    error = model.parameters[name].standard_error
    return error is not None and abs(model.parameters[name].value - value) <= POLICY.confidence * error


def _closest(model: Model, name: str, leave_out: Collection[str]) -> tuple[str | None, float]:
    """The collinear parameter that is not one of these, and the correlation of the errors; None where there is none."""
    others = [other for other in model.free if other == name or other not in leave_out]
    covariance = model.covariance(others)
    row = others.index(name)
    with np.errstate(divide="ignore", invalid="ignore"):
        errors = np.sqrt(np.diag(covariance))
        correlation = np.nan_to_num(covariance[row] / (errors[row] * errors))
    correlation[row] = 0.0
    best = int(np.argmax(np.abs(correlation)))
    found = float(correlation[best])
    return (others[best], found) if abs(found) >= _COLLINEAR else (None, 0.0)
